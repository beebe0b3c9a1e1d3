// SPDX-License-Identifier: BSD-3-Clause
// The web page by https.
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <memory>
#include <string>
#include <thread>

#include "beast/server.h"
#include "support/process/certificate.h"
#include "support/temporary_folder.h"
#include "viewer/web/web_run.h"
#include "vps/errors.h"
#include "vps/write_file.h"

namespace vps::viewer {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace ssl = boost::asio::ssl;
namespace websocket = beast::websocket;
using boost::asio::ip::tcp;
using TlsStream = beast::ssl_stream<tcp::socket>;

class WebTls : public testing::Test {
 protected:
  void SetUp() override {
    if (!missingForWeb().empty()) GTEST_SKIP() << missingForWeb();
    vps::test::writeCertificate(folder(), "good");
    vps::test::writeCertificate(folder(), "other");
  }
  void TearDown() override {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  [[nodiscard]] std::string folder() const { return folder_.path().string(); }
  [[nodiscard]] std::string path(const std::string& name) const { return folder() + "/" + name; }

  [[nodiscard]] WebOptions options(const std::string& certificate, const std::string& key) const {
    WebOptions options;
    options.port = 0;
    options.stop = &stop_;
    options.tls_certificate = path(certificate);
    options.tls_key = path(key);
    return options;
  }
  void begin() {
    server_ = std::make_unique<WebServer>(run_, options("good.pem", "good.key"));
    run_.show(0.05);
    thread_ = std::thread([this] { server_->serve(); });
  }
  /// Connects as a client that trusts the certificate. Throws if the server cannot prove its identity.
  TlsStream connect() {
    TlsStream stream(io_, context_);
    stream.next_layer().connect({boost::asio::ip::address_v4::loopback(), server_->port()});
    stream.handshake(ssl::stream_base::client);
    return stream;
  }
  void trust(const std::string& certificate) {
    context_.set_verify_mode(ssl::verify_peer);
    context_.load_verify_file(path(certificate));
    context_.set_verify_callback(ssl::host_name_verification("localhost"));
  }
  [[nodiscard]] std::string host() const { return "127.0.0.1:" + std::to_string(server_->port()); }
  /// Error message of a server that cannot be started.
  std::string refusal(const std::string& certificate, const std::string& key) {
    try {
      const WebServer server(run_, options(certificate, key));
      return "";
    } catch (const LoadError& refused) {
      return refused.what();
    }
  }

  vps::test::TemporaryFolder folder_;
  std::atomic<bool> stop_{false};
  test::FakeRun run_;
  std::unique_ptr<WebServer> server_;
  std::thread thread_;
  boost::asio::io_context io_;
  ssl::context context_{ssl::context::tls_client};
};

TEST_F(WebTls, ThePageAndItsSocketComeEncryptedFromTheServerOfTheCertificate) {
  begin();
  trust("good.pem");
  EXPECT_EQ(server_->address(), "https://" + host() + "/");
  TlsStream page = connect();
  http::request<http::empty_body> request(http::verb::get, "/", 11);
  request.set(http::field::host, host());
  http::write(page, request);
  beast::flat_buffer buffer;
  http::response<http::string_body> response;
  http::read(page, buffer, response);
  EXPECT_EQ(response.result_int(), 200U);
  EXPECT_NE(response.body().find("<canvas"), std::string::npos);
  const std::string policy(response["Content-Security-Policy"]);
  EXPECT_NE(policy.find("wss://" + host()), std::string::npos) << policy;

  websocket::stream<TlsStream> socket(connect());
  socket.set_option(websocket::stream_base::decorator(
      [this](websocket::request_type& upgrade) { upgrade.set(http::field::origin, "https://" + host()); }));
  socket.handshake(host(), "/run");
  beast::flat_buffer first;
  socket.read(first);
  EXPECT_NE(beast::buffers_to_string(first.data()).find("hello"), std::string::npos);
}

TEST_F(WebTls, ABrowserThatTrustsAnotherCertificateIsNotServed) {
  begin();
  trust("other.pem");
  EXPECT_THROW(connect(), boost::system::system_error);
}

TEST_F(WebTls, WithoutEncryptionNothingIsServed) {
  begin();
  tcp::socket plain(io_);
  plain.connect({boost::asio::ip::address_v4::loopback(), server_->port()});
  const std::string request = "GET / HTTP/1.1\r\nHost: " + host() + "\r\n\r\n";
  boost::asio::write(plain, boost::asio::buffer(request));
  std::string answer;
  boost::system::error_code over;
  boost::asio::read(plain, boost::asio::dynamic_buffer(answer), over);
  EXPECT_EQ(answer.find("canvas"), std::string::npos);
  EXPECT_TRUE(over);
  trust("good.pem");
  EXPECT_NO_THROW(connect());  // other clients are still served
}

TEST_F(WebTls, FilesThatAreMissingOrWrongAreNamedInPlainWords) {
  writeWholeFile(path("words.pem"), "no certificate\n");
  writeWholeFile(path("empty.pem"), "");
  vps::test::writeCertificate(folder(), "old", -7200, -3600);
  vps::test::writeCertificate(folder(), "early", 3600, 7200);
  const auto expectWords = [&](const std::string& certificate, const std::string& key,
                               const std::string& file, const std::string& words) {
    const std::string said = refusal(certificate, key);
    EXPECT_NE(said.find(path(file)), std::string::npos) << said;
    EXPECT_NE(said.find(words), std::string::npos) << said;
  };
  expectWords("none.pem", "good.key", "none.pem", "cannot be read: No such file");
  expectWords("none.pem", "good.key", "none.pem", "openssl req -x509");
  expectWords("good.pem", "none.key", "none.key", "cannot be read: No such file");
  expectWords("empty.pem", "good.key", "empty.pem", "is empty");
  expectWords("words.pem", "good.key", "words.pem", "holds no certificate in PEM form");
  expectWords("good.pem", "words.pem", "words.pem", "holds no private key in PEM form");
  expectWords("good.pem", "other.key", "other.key", "is not the key of");
  expectWords("old.pem", "old.key", "old.pem", "has expired");
  expectWords("early.pem", "early.key", "early.pem", "is not valid yet");
  vps::test::writeCertificate(folder(), "weak", -3600, 3600, 1024);
  expectWords("weak.pem", "weak.key", "weak.pem", "too weak");
}

}  // namespace
}  // namespace vps::viewer
