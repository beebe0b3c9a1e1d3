// SPDX-License-Identifier: BSD-3-Clause
#include "dds/topics.h"

#include <dds/dds.h>
#include <dlfcn.h>

#include <array>
#include <filesystem>

#include "vps/errors.h"

namespace vps::scenes {

namespace {

namespace fs = std::filesystem;

constexpr const char* kUnsecured = "none";

/// Folder of the security plugins: the folder of the Cyclone DDS library, or Debian's subfolder of that
/// folder.
fs::path pluginFolder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&dds_create_participant), &info) != 0 &&
      info.dli_fname != nullptr) {
    const fs::path library = fs::path(info.dli_fname).parent_path();
    for (const fs::path& folder : {library / "libddsc0debian", library})
      if (fs::exists(folder / "libdds_security_auth.so")) return folder;
  }
  throw LoadError("", "", "--security needs the security plugins of Cyclone DDS, which this machine lacks");
}

std::string fileOf(const fs::path& folder, const char* name) {
  const fs::path file = fs::absolute(folder / name);
  if (!fs::exists(file))
    throw LoadError(
        folder.string(), "",
        std::string("has no ") + name + "; scenes/make_certificates.sh makes a folder for each node");
  // Cyclone DDS's settings are XML, in which the characters <, >, & and " are special.
  for (const char c : file.string())
    if (c == '<' || c == '>' || c == '&' || c == '"')
      throw LoadError(file.string(), "",
                      "contains a character that --security does not support; rename the folder");
  return "file:" + file.string();
}

std::string element(const std::string& name, const std::string& inside) {
  return "<" + name + ">" + inside + "</" + name + ">";
}

std::string plugin(const std::string& file, const std::string& function) {
  return "<Library path=\"" + (pluginFolder() / file).string() + "\" initFunction=\"init_" + function +
         "\" finalizeFunction=\"finalize_" + function + "\"/>";
}

}  // namespace

std::string securitySettings(const SessionNetwork& network, bool is_loopback) {
  if (network.security == kUnsecured) return {};
  if (network.security.empty()) {
    if (is_loopback) return {};
    throw LoadError("", "",
                    "--network " + network.interface +
                        " gives everybody who can reach it read and write access; add --security FOLDER with "
                        "the certificates that scenes/make_certificates.sh makes, or --security none");
  }
  const fs::path folder = network.security;
  const std::string authority = fileOf(folder, "ca.pem");
  return element(
      "Security",
      element("Authentication", plugin("libdds_security_auth.so", "authentication") +
                                    element("IdentityCA", authority) +
                                    element("IdentityCertificate", fileOf(folder, "identity.pem")) +
                                    element("PrivateKey", fileOf(folder, "key.pem"))) +
          element("AccessControl", plugin("libdds_security_ac.so", "access_control") +
                                       element("PermissionsCA", authority) +
                                       element("Governance", fileOf(folder, "governance.p7s")) +
                                       element("Permissions", fileOf(folder, "permissions.p7s"))) +
          element("Cryptographic", plugin("libdds_security_crypto.so", "crypto")));
}

}  // namespace vps::scenes
