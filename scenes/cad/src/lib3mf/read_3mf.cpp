// SPDX-License-Identifier: BSD-3-Clause
// Reads 3MF by lib3mf: the objects that the build places, with units, names, components and colours. Sources:
// 3MF Core Specification 1.3, Materials and Properties Extension 1.2.
#include <Common/NMR_ErrorConst.h>
#include <Model/COM/NMR_DLLInterfaces.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string_view>

#include "color/palette.h"
#include "import/part_names.h"
#include "import/readers.h"
#include "lib3mf/model_files.h"
#include "vps/errors.h"

namespace vps::scenes::import {
namespace {

/// Thrown when a call of lib3mf fails.
struct Failed {};

void require(LIB3MFRESULT result) {
  if (result != LIB3MF_OK) throw Failed();
}

struct Release {
  void operator()(NMR::PLib3MFBase* object) const { NMR::lib3mf_release(object); }
};
/// An object of lib3mf, whose interface has a pointer to void for every class.
using Object = std::unique_ptr<NMR::PLib3MFBase, Release>;

/// The value that f(arguments..., address) writes to the address.
template <class T, class F, class... Arguments>
T valueOf(F f, Arguments... arguments) {
  T value{};
  require(f(arguments..., &value));
  return value;
}
template <class F, class... Arguments>
Object objectOf(F f, Arguments... arguments) {
  auto* object = valueOf<NMR::PLib3MFBase*>(f, arguments...);
  if (object == nullptr) throw Failed();
  return Object(object);
}

template <class F, class... Arguments>
std::string textOf(F f, Arguments... arguments) {
  ULONG length = 0;
  require(f(arguments..., nullptr, 0, &length));
  std::string text(length + 1, '\0');
  require(f(arguments..., text.data(), static_cast<ULONG>(text.size()), &length));
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

constexpr std::array<std::pair<std::string_view, double>, 6> kUnits = {
    {{"micron", 1e-6},
     {"millimeter", 1e-3},
     {"centimeter", 1e-2},
     {"inch", 25.4e-3},
     {"foot", 0.3048},
     {"meter", 1}}};  // in the order of lib3mf's constants

std::string counted(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? " is" : "s are");
}

/// Converts lib3mf's matrix, whose columns are the images of the axes and of the origin.
Eigen::Affine3d affine(const NMR::MODELTRANSFORM& transform) {
  Eigen::Affine3d X = Eigen::Affine3d::Identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      X(row, column) = static_cast<double>(transform.m_fFields[row][column]);
  return X;
}

Color linear(const NMR::MODELMESHCOLOR_SRGB& c) {
  return linearFromSrgb({float(c.m_Red) / 255, float(c.m_Green) / 255, float(c.m_Blue) / 255});
}

class Reader {
 public:
  Reader(const std::string& file, const ImportSettings& settings, RawCad& cad)
      : file_(file), settings_(settings), cad_(cad) {}

  void read() {
    if (const std::string fault = modelFault(file_); !fault.empty())
      throw LoadError(file_, "", "is not a readable 3MF file (" + fault + "); export it again");
    std::string words;
    Object reader = readModel("", words);
    if (!reader)
      if (const std::string bytes = readableArchive(file_); !bytes.empty()) reader = readModel(bytes, words);
    if (!reader) throw LoadError(file_, "", "is not a readable 3MF file (" + words + "); export it again");
    addRemarks(reader);
    readUnit();
    const Object items = objectOf(NMR::lib3mf_model_getbuilditems, model_.get());
    while (valueOf<BOOL>(NMR::lib3mf_builditemiterator_movenext, items.get()) != 0) {
      const Object item = objectOf(NMR::lib3mf_builditemiterator_getcurrent, items.get());
      Eigen::Affine3d X_WO = Eigen::Affine3d::Identity();
      if (valueOf<BOOL>(NMR::lib3mf_builditem_hasobjecttransform, item.get()) != 0)
        X_WO = affine(valueOf<NMR::MODELTRANSFORM>(NMR::lib3mf_builditem_getobjecttransform, item.get()));
      visit(objectOf(NMR::lib3mf_builditem_getobjectresource, item.get()), X_WO, "", {});
    }
    if (cad_.parts.empty())
      throw LoadError(file_, "", "places no object with a mesh; export it again with its objects placed");
    if (supports_ > 0)
      cad_.warnings.push_back(counted(supports_, "object") +
                              " for printing only (supports, or of type 'other') and left out");
    if (bad_colors_ > 0)
      cad_.warnings.push_back(
          counted(bad_colors_, "colour") +
          " referred to but missing in the file; the object's own colour, or grey, is used instead");
  }

 private:
  /// Reads the model.
  /// @return the reader, which has the warnings; null if it fails, with lib3mf's reason in `words`
  /// @param bytes  archive that is read in place of the file; empty: the file is read
  Object readModel(std::string bytes, std::string& words) {
    model_ = objectOf(NMR::lib3mf_createmodel);
    Object reader = objectOf(NMR::lib3mf_model_queryreader, model_.get(), "3mf");
    const LIB3MFRESULT result = bytes.empty()
                                    ? NMR::lib3mf_reader_readfromfileutf8(reader.get(), file_.c_str())
                                    : NMR::lib3mf_reader_readfrombuffer(
                                          reader.get(), reinterpret_cast<BYTE*>(bytes.data()), bytes.size());
    if (result == LIB3MF_OK) return reader;
    DWORD code = 0;
    LPCSTR text = nullptr;
    NMR::lib3mf_getlasterror(reader.get(), &code, &text);
    words = text == nullptr || *text == '\0' ? "lib3mf gives no reason" : text;
    return nullptr;
  }

  /// Reads the unit of the root model, which by the specification applies to all model files.
  void readUnit() {
    const ModelFiles files = modelFiles(file_);
    requires_beams_ = files.root && std::ranges::any_of(files.root->required, [](const std::string& space) {
                        return space.find("/beamlattice/") != std::string::npos;
                      });
    const auto number = valueOf<DWORD>(NMR::lib3mf_model_getunit, model_.get());
    const std::string stated = files.root ? files.root->unit : std::string(kUnits.at(number).first);
    for (const ModelFile& other : files.others)
      if (files.root && other.unit != stated) {
        cad_.warnings.push_back("states the unit '" + stated + "', which is used, and the unit '" +
                                other.unit + "' in " + other.name);
        break;
      }
    const auto known = std::ranges::find(kUnits, stated, &std::pair<std::string_view, double>::first);
    cad_.states_unit = known != kUnits.end();
    cad_.unit_m = cad_.states_unit ? known->second : settings_.unit_m.value_or(1e-3);
    if (!cad_.states_unit && !settings_.unit_m)
      cad_.warnings.push_back("states the unit '" + stated +
                              "', which 3MF does not define: millimetres are assumed; set unit or --units");
  }

  /// Warns of violations of the specification that lib3mf finds. Attributes and metadata that slicers add are
  /// ignored.
  void addRemarks(const Object& reader) {
    constexpr std::array<DWORD, 7> kNoMatter = {
        NMR_ERROR_INVALIDMODELUNIT,  // see readUnit()

        NMR_ERROR_MISSINGUUID,      NMR_ERROR_NAMESPACE_INVALID_ATTRIBUTE,
        NMR_ERROR_UNKNOWNMETADATA,  NMR_ERROR_METADATA_COULDNOTGETNAMESPACE,
        NMR_ERROR_INVALIDMETADATA,  NMR_ERROR_DUPLICATEMETADATA};
    std::string first;
    int others = -1;
    const auto count = valueOf<DWORD>(NMR::lib3mf_reader_getwarningcount, reader.get());
    for (DWORD i = 0; i < count; ++i) {
      DWORD code = 0;
      const std::string words = textOf(NMR::lib3mf_reader_getwarningutf8, reader.get(), i, &code);
      if (code == NMR_ERROR_REQUIREDEXTENSIONNOTSUPPORTED)
        throw LoadError(file_, "",
                        "needs an extension of 3MF that is not read; export it again without extensions");
      if (std::ranges::find(kNoMatter, code) != kNoMatter.end()) continue;
      if (++others == 0) first = words;
    }
    if (first.empty()) return;
    cad_.warnings.push_back("violates the 3MF specification and was read as far as possible: " + first +
                            (others > 0 ? " (and " + std::to_string(others) + " more)" : ""));
  }

  void visit(const Object& object, const Eigen::Affine3d& X_WO, std::string name,
             std::vector<std::string> within) {
    // Assumed limits, above those of real assemblies: a file of 3 kB can place 10 million objects.
    constexpr std::size_t kMostLevels = 100, kMostVisits = 200'000;
    if (within.size() >= kMostLevels || ++visits_ > kMostVisits)
      throw LoadError(file_, "",
                      "has more than " + std::to_string(kMostLevels) +
                          " levels of components, or places more than " + std::to_string(kMostVisits) +
                          " objects; export fewer into one file");
    if (const std::string own = textOf(NMR::lib3mf_object_getnameutf8, object.get()); !own.empty())
      name = own;
    const auto type = valueOf<DWORD>(NMR::lib3mf_object_gettype, object.get());
    if (type == NMR::MODELOBJECTTYPE_SUPPORT || type == NMR::MODELOBJECTTYPE_SOLIDSUPPORT ||
        type == NMR::MODELOBJECTTYPE_OTHER) {
      ++supports_;
      return;
    }
    within.push_back(instances_.unique(name.empty() ? "object" : name));
    if (valueOf<BOOL>(NMR::lib3mf_object_iscomponentsobject, object.get()) != 0) {
      const auto count = valueOf<DWORD>(NMR::lib3mf_componentsobject_getcomponentcount, object.get());
      for (DWORD i = 0; i < count; ++i) {
        const Object component = objectOf(NMR::lib3mf_componentsobject_getcomponent, object.get(), i);
        const Eigen::Affine3d X_OC =
            affine(valueOf<NMR::MODELTRANSFORM>(NMR::lib3mf_component_gettransform, component.get()));
        visit(objectOf(NMR::lib3mf_component_getobjectresource, component.get()), X_WO * X_OC, name, within);
      }
      return;
    }
    const auto [known, is_new] =
        meshes_.try_emplace(valueOf<DWORD>(NMR::lib3mf_resource_getresourceid, object.get()));
    if (is_new) readMesh(object, name, known->second);
    if (known->second.mesh.triangles.empty()) return;
    RawPart part = known->second;
    part.name = name;
    part.X_WP = X_WO;
    part.within = std::move(within);
    part.rounding = floatRounding(part.mesh, X_WO);
    cad_.parts.push_back(std::move(part));
  }

  void readMesh(const Object& object, const std::string& name, RawPart& part) {
    const auto vertex_count = valueOf<DWORD>(NMR::lib3mf_meshobject_getvertexcount, object.get()),
               triangle_count = valueOf<DWORD>(NMR::lib3mf_meshobject_gettrianglecount, object.get());
    std::vector<NMR::MODELMESHVERTEX> vertices(vertex_count);
    std::vector<NMR::MODELMESHTRIANGLE> triangles(triangle_count);
    const auto beam_count = valueOf<DWORD>(NMR::lib3mf_meshobject_getbeamcount, object.get());
    const std::string whose = name.empty() ? "an object" : "object '" + name + "'";
    if (beam_count > 0 && requires_beams_)
      throw LoadError(file_, name,
                      "has a lattice of beams, which the file marks as required and which is not read; "
                      "export it as a mesh");
    if (beam_count > 0)
      cad_.warnOfMissing(whose + " has a lattice of " + std::to_string(beam_count) +
                         " beams, which are not read; export it as a mesh");
    if (vertex_count == 0 || triangle_count == 0) {
      cad_.warnings.push_back(whose + " has no triangles and is left out");
      return;
    }
    require(NMR::lib3mf_meshobject_getvertices(object.get(), vertices.data(), vertex_count, nullptr));
    require(
        NMR::lib3mf_meshobject_gettriangleindices(object.get(), triangles.data(), triangle_count, nullptr));
    for (const NMR::MODELMESHVERTEX& p : vertices)
      part.mesh.vertices.emplace_back(p.m_fPosition[0], p.m_fPosition[1], p.m_fPosition[2]);
    for (const NMR::MODELMESHTRIANGLE& t : triangles)
      part.mesh.triangles.push_back({t.m_nIndices[0], t.m_nIndices[1], t.m_nIndices[2]});
    readColors(object, triangle_count, part);
  }

  /// The result of f, or `otherwise` if the file lacks the colour.
  template <class F>
  Color colorOr(const Color& otherwise, F f) {
    try {
      return f();
    } catch (const Failed&) {
      ++bad_colors_;
      return otherwise;
    }
  }

  /// Reads the colours of base materials and colour groups; a triangle whose corners have several colours has
  /// their mean.
  void readColors(const Object& object, DWORD triangle_count, RawPart& part) {
    part.color = colorOr(part.color, [&] { return colorOfWhole(object, part.color); });
    const Object own = objectOf(NMR::lib3mf_meshobject_createpropertyhandler, object.get());
    Palette palette(part.face_colors);
    for (DWORD i = 0; i < triangle_count; ++i)
      palette.add(colorOr(part.color, [&] { return colorOf(own, i, part.color); }));
  }

  Color colorOfWhole(const Object& object, const Color& otherwise) const {
    const Object whole = objectOf(NMR::lib3mf_object_createdefaultpropertyhandler, object.get());
    const auto type =
        valueOf<NMR::eModelPropertyType>(NMR::lib3mf_defaultpropertyhandler_getpropertytype, whole.get());
    if (type == NMR::MODELPROPERTYTYPE_COLOR)
      return linear(valueOf<NMR::MODELMESHCOLOR_SRGB>(NMR::lib3mf_defaultpropertyhandler_getcolor,
                                                      whole.get(), DWORD(0)));
    if (type != NMR::MODELPROPERTYTYPE_BASEMATERIALS) return otherwise;
    DWORD group = 0, index = 0;
    require(NMR::lib3mf_defaultpropertyhandler_getbasematerial(whole.get(), &group, &index));
    return materialColor(group, index, otherwise);
  }

  Color colorOf(const Object& handler, DWORD triangle, const Color& of_object) const {
    switch (valueOf<NMR::eModelPropertyType>(NMR::lib3mf_propertyhandler_getpropertytype, handler.get(),
                                             triangle)) {
      case NMR::MODELPROPERTYTYPE_BASEMATERIALS: {
        DWORD group = 0, index = 0;
        require(NMR::lib3mf_propertyhandler_getbasematerial(handler.get(), triangle, &group, &index));
        return materialColor(group, index, of_object);
      }
      case NMR::MODELPROPERTYTYPE_COLOR: {
        const auto corners = valueOf<NMR::MODELMESH_TRIANGLECOLOR_SRGB>(NMR::lib3mf_propertyhandler_getcolor,
                                                                        handler.get(), triangle);
        Color mean{};
        for (const NMR::MODELMESHCOLOR_SRGB& corner : corners.m_Colors)
          for (std::size_t k = 0; k < 3; ++k) mean[k] += linear(corner)[k] / 3;
        return mean;
      }
      default:
        return of_object;
    }
  }

  Color materialColor(DWORD group, DWORD index, const Color& otherwise) const {
    NMR::PLib3MFBase* found = nullptr;
    if (NMR::lib3mf_model_getbasematerialbyid(model_.get(), group, &found) != LIB3MF_OK || found == nullptr)
      return otherwise;
    const Object materials(found);
    NMR::MODELMESHCOLOR_SRGB c{};
    BYTE alpha = 0;
    require(NMR::lib3mf_basematerial_getdisplaycolor(materials.get(), index, &c.m_Red, &c.m_Green, &c.m_Blue,
                                                     &alpha));
    return linear(c);
  }

  const std::string& file_;
  const ImportSettings& settings_;
  RawCad& cad_;
  Object model_;
  UniqueNames instances_;
  std::map<DWORD, RawPart> meshes_;  ///< meshes with colours, by the number of their object
  bool requires_beams_ = false;      ///< the file marks beam lattices as required
  std::size_t supports_ = 0, bad_colors_ = 0, visits_ = 0;
};

}  // namespace

RawCad read3mf(const std::string& file, const FileFormat&, const ImportSettings& settings, const Progress&) {
  RawCad cad;
  try {
    Reader(file, settings, cad).read();
  } catch (const Failed&) {
    throw LoadError(file, "",
                    "is not a readable 3MF file (lib3mf refuses one of its objects); export it again");
  }
  return cad;
}

}  // namespace vps::scenes::import
