// SPDX-License-Identifier: BSD-3-Clause
// Reads STEP and IGES with names, tree, poses and colours (Open CASCADE's XDE), and BREP.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <sstream>

#include <BRepGProp.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <IGESControl_Controller.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <Standard_Version.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopTools_DataMapOfShapeShape.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include "import/part_names.h"
#include "import/readers.h"
#include "occt/file_faults.h"
#include "occt/occt_progress.h"
#include "occt/tessellate_all.h"
#include "vps/errors.h"

namespace vps::scenes::import {
namespace {

/// Removes Open CASCADE's console printers for a scope.
class Quiet {
 public:
  Quiet() : printers_(Message::DefaultMessenger()->Printers()) {
    Message::DefaultMessenger()->ChangePrinters().Clear();
  }
  ~Quiet() { Message::DefaultMessenger()->ChangePrinters() = printers_; }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  Message_SequenceOfPrinters printers_;
};

/// A document that is closed at the end of its scope.
class Document {
 public:
  Document() { XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document_); }
  ~Document() { XCAFApp_Application::GetApplication()->Close(document_); }
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;
  [[nodiscard]] Handle(TDocStd_Document) & get() { return document_; }

 private:
  Handle(TDocStd_Document) document_;
};

Eigen::Affine3d affine(const gp_Trsf& t) {
  Eigen::Affine3d X = Eigen::Affine3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) X(row, column) = t.Value(row + 1, column + 1);
  }
  return X;
}

std::string nameOf(const TDF_Label& label) {
  Handle(TDataStd_Name) attribute;
  if (!label.FindAttribute(TDataStd_Name::GetID(), attribute)) return "";
  const TCollection_AsciiString utf8(attribute->Get());
  return utf8.ToCString();
}

/// Error of the triangles: their greatest distance from the exact faces [m].
double errorOf(const Tessellation& made, const ImportSettings& settings) {
  return made.deflection_m > settings.deflection_m ? std::max(made.deviation_m, made.deflection_m)
                                                   : made.deviation_m;
}

/// The tree of an assembly: its products are triangulated once each, and its leaves become parts.
class Tree {
 public:
  Tree(const Handle(TDocStd_Document) & document, const ImportSettings& settings, const Progress& progress,
       RawCad& cad)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        colors_(XCAFDoc_DocumentTool::ColorTool(document->Main())),
        settings_(settings),
        progress_(progress),
        cad_(cad) {
    shapes_->GetFreeShapes(roots_);
    for (const TDF_Label& root : roots_) countProducts(root);
    for (const TDF_Label& root : roots_) collect(root, nameOf(root));
  }

  /// The shapes of all products.
  [[nodiscard]] const std::vector<TopoDS_Shape>& shapes() const { return all_shapes_; }

  /// Adds the leaves as parts. @param tessellated  the tessellations of shapes()
  void addParts(TessellatedShapes tessellated) {
    tessellated_ = std::move(tessellated);
    for (const TDF_Label& root : roots_) {
      // A single shape may have a location.
      const Color* none = nullptr;
      visit(root, {}, Eigen::Affine3d::Identity(), none);
    }
  }

 private:
  struct Piece {
    Tessellation tessellation;
    Eigen::Affine3d X_PieceMesh;  ///< in file units
    Color color;
    bool has_color;
    bool is_by_faces = false;  ///< `color` is the colour of most of the faces
    std::vector<std::optional<Color>>
        of_faces;  ///< colours of the tessellation's faces; empty: no face has a colour
  };

  /// Calls f(component) for each component of an assembly.
  template <class F>
  static void forComponents(const TDF_Label& assembly, F f) {
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(assembly, components);
    for (const TDF_Label& component : components) f(component);
  }

  static TDF_Label referred(const TDF_Label& label) {
    TDF_Label target;
    return XCAFDoc_ShapeTool::GetReferredShape(label, target) ? target : label;
  }

  void countProducts(const TDF_Label& label) {
    const TDF_Label product = referred(label);
    if (XCAFDoc_ShapeTool::IsAssembly(product))
      forComponents(product, [&](const TDF_Label& component) { countProducts(component); });
    else
      product_entries_.insert(entryOf(product));
  }

  /// Collects the pieces of each product below a label; `name` is for the progress.
  void collect(const TDF_Label& label, std::string name) {
    const TDF_Label product = referred(label);
    if (const std::string own_name = bestName(nameOf(label), nameOf(product)); !own_name.empty())
      name = own_name;
    if (XCAFDoc_ShapeTool::IsAssembly(product)) {
      forComponents(product, [&](const TDF_Label& component) { collect(component, name); });
      return;
    }
    const auto [it, is_new] = first_shape_.try_emplace(entryOf(product), all_shapes_.size());
    if (!is_new) return;
    const auto tell = [&](double share) {
      if (progress_)
        progress_("reading the faces of " + name, (static_cast<double>(first_shape_.size() - 1) + share) /
                                                      static_cast<double>(product_entries_.size()));
    };
    tell(0);
    const auto remember = [this](const TopoDS_Shape& sewn, const TopoDS_Shape& face) {
      unsewn_.Bind(sewn, face);
    };
    for (const TopoDS_Shape& shape : pieces(XCAFDoc_ShapeTool::GetShape(product), tell, remember))
      all_shapes_.push_back(shape);
    shape_end_[it->first] = all_shapes_.size();
  }

  /// Name and assemblies that an instance inherits.
  struct Above {
    std::string name;
    std::vector<std::string> within;
  };

  void visit(const TDF_Label& label, Above above, const Eigen::Affine3d& X_WParent,
             const Color* color_above) {
    const TDF_Label product = referred(label);
    const std::string own_name = bestName(nameOf(label), nameOf(product));
    if (!own_name.empty()) above.name = own_name;
    const std::string& name = above.name;
    above.within.push_back(instances_.unique(name.empty() ? "product" : name));
    const Eigen::Affine3d X_WP =
        label == product ? X_WParent
                         : X_WParent * affine(XCAFDoc_ShapeTool::GetLocation(label).Transformation());
    Color own{};
    // The instance's colour overrides its product's; a colour of an assembly applies only where both have
    // none.
    const bool is_instance_colored = label != product && colorOf(label, own);
    const bool has_own = is_instance_colored || colorOf(product, own);
    const Color* color = has_own ? &own : color_above;
    if (XCAFDoc_ShapeTool::IsAssembly(product)) {
      forComponents(product, [&](const TDF_Label& component) { visit(component, above, X_WP, color); });
      return;
    }
    for (const Piece& piece : piecesOf(product)) {
      RawPart part;
      part.name = name;
      part.mesh = piece.tessellation.mesh;
      part.deviation_m = errorOf(piece.tessellation, settings_);
      part.note = inWords(piece.tessellation, settings_);
      part.X_WP = X_WP * piece.X_PieceMesh;
      part.within = above.within;
      if (piece.has_color) part.color = piece.color;
      if (color) part.color = *color;
      // Only a colour of this instance overrides the faces' own colours.
      if (!is_instance_colored && !piece.of_faces.empty())
        part.face_colors = faceColors(piece, !color && piece.is_by_faces ? ImportedPart().color : part.color);
      cad_.parts.push_back(std::move(part));
    }
  }

  static std::string entryOf(const TDF_Label& label) {
    TCollection_AsciiString entry;
    TDF_Tool::Entry(label, entry);
    return entry.ToCString();
  }

  const std::vector<Piece>& piecesOf(const TDF_Label& product) {
    const auto [it, is_new] = products_.try_emplace(entryOf(product));
    if (!is_new) return it->second;
    const ColoredFaces colored(product, *this);
    for (std::size_t i = first_shape_.at(it->first); i < shape_end_.at(it->first); ++i) {
      const TopoDS_Shape& shape = all_shapes_[i];
      Piece piece;
      piece.has_color = colorOf(shape, piece.color, piece.is_by_faces);
      piece.tessellation = tessellated_.tessellations[tessellated_.shapes[i].number];
      piece.X_PieceMesh = tessellated_.shapes[i].X_ST;
      piece.of_faces = colored.of(shape);  // a rigid copy has its faces in the order of the original
      // Healing may have changed the number of faces.
      if (piece.of_faces.size() != piece.tessellation.faces.size()) piece.of_faces.clear();
      it->second.push_back(std::move(piece));
    }
    return it->second;
  }

  /// The colours of single faces of a product.
  class ColoredFaces {
   public:
    ColoredFaces(const TDF_Label& product, const Tree& tree) : tree_(tree) {
      TDF_LabelSequence labels;
      XCAFDoc_ShapeTool::GetSubShapes(product, labels);
      for (const TDF_Label& label : labels) {
        const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label);
        Color color{};
        if (shape.IsNull() || shape.ShapeType() != TopAbs_FACE || !tree.colorOf(label, color)) continue;
        number_of_.Bind(shape, static_cast<int>(colors_.size()));
        colors_.push_back(color);
      }
    }
    /// Colours by face, in the order of TopExp_Explorer; empty if no face has a colour.
    [[nodiscard]] std::vector<std::optional<Color>> of(const TopoDS_Shape& shape) const {
      std::vector<std::optional<Color>> out;
      bool has_any = false;
      for (TopExp_Explorer it(shape, TopAbs_FACE); !colors_.empty() && it.More(); it.Next()) {
        std::optional<Color>& color = out.emplace_back();
        int number = 0;
        if (!number_of_.Find(tree_.unsewn(it.Current()), number)) continue;
        color = colors_[static_cast<std::size_t>(number)];
        has_any = true;
      }
      if (!has_any) out.clear();
      return out;
    }

   private:
    const Tree& tree_;
    std::vector<Color> colors_;
    TopTools_DataMapOfShapeInteger number_of_;
  };

  static FaceColors faceColors(const Piece& piece, const Color& other) {
    FaceColors colors;
    for (std::size_t i = 0; i < piece.of_faces.size(); ++i)
      append(colors, piece.tessellation.faces[i].triangles, {}, piece.of_faces[i].value_or(other));
    return colors;
  }

  /// The face of the file from which a face was made when loose faces were sewn; otherwise the face itself.
  [[nodiscard]] TopoDS_Shape unsewn(const TopoDS_Shape& face) const {
    TopoDS_Shape from;
    return unsewn_.Find(face, from) ? from : face;
  }

  static Color linear(const Quantity_Color& c) { return {float(c.Red()), float(c.Green()), float(c.Blue())}; }

  bool colorOf(const TDF_Label& label, Color& out) const {
    Quantity_Color c;
    for (const XCAFDoc_ColorType type : {XCAFDoc_ColorGen, XCAFDoc_ColorSurf}) {
      if (!colors_->GetColor(label, type, c)) continue;
      out = linear(c);
      return true;
    }
    return false;
  }

  /// The solid's colour, or else the colour that covers most area among its coloured faces. False if neither
  /// colour exists.
  bool colorOf(const TopoDS_Shape& shape, Color& out, bool& is_by_faces) const {
    const auto has = [&](const TopoDS_Shape& s) {
      Quantity_Color c;
      for (const XCAFDoc_ColorType type : {XCAFDoc_ColorGen, XCAFDoc_ColorSurf}) {
        if (!colors_->GetColor(s, type, c)) continue;
        out = linear(c);
        return true;
      }
      return false;
    };
    is_by_faces = false;
    if (has(shape)) return true;
    is_by_faces = true;
    std::map<Color, double> area_of;
    for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
      if (!has(unsewn(it.Current()))) continue;
      GProp_GProps face;
      BRepGProp::SurfaceProperties(it.Current(), face);
      area_of[out] += face.Mass();
    }
    if (area_of.empty()) return false;
    out = std::ranges::max_element(area_of, {}, [](const auto& one) { return one.second; })->first;
    return true;
  }

  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colors_;
  const ImportSettings& settings_;
  const Progress& progress_;
  RawCad& cad_;
  TDF_LabelSequence roots_;
  std::map<std::string, std::vector<Piece>> products_;
  UniqueNames instances_;
  TopTools_DataMapOfShapeShape unsewn_;
  std::vector<TopoDS_Shape> all_shapes_;
  std::set<std::string> product_entries_;                       // entries of all products, for the progress
  std::map<std::string, std::size_t> first_shape_, shape_end_;  // ranges of products in all_shapes_
  TessellatedShapes tessellated_;
};

LoadError unreadable(const std::string& file, const FileFormat& format, const std::string& why) {
  return {file, "", "is not a readable " + format.name + " file (" + why + "); export it again"};
}

XSControl_Reader& basic(STEPCAFControl_Reader& reader) {
  return reader.ChangeReader();
}
XSControl_Reader& basic(IGESCAFControl_Reader& reader) {
  return reader;
}

/// Open CASCADE reads IGES from files only, so that a changed text goes into a file that has no name any
/// more.
IFSelect_ReturnStatus readIges(XSControl_Reader& reader, const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const std::optional<std::string> plain = withPlainLines(text);
  if (!plain) return reader.ReadFile(file.c_str());
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> other(std::tmpfile(), std::fclose);
  if (!other || std::fwrite(plain->data(), 1, plain->size(), other.get()) != plain->size() ||
      std::fflush(other.get()) != 0)
    return IFSelect_RetFail;
  std::rewind(other.get());
  return reader.ReadFile(("/dev/fd/" + std::to_string(fileno(other.get()))).c_str());
}

IFSelect_ReturnStatus readText(XSControl_Reader& reader, const std::string& file, const FileFormat& format) {
  if (format.id == CadFormat::Iges) return readIges(reader, file);
  std::ifstream in(file, std::ios::binary);
  std::string text(std::filesystem::file_size(file), '\0');
  in.read(text.data(), std::ssize(text));
  bool is_changed = text.starts_with(kByteOrderMark);
  if (is_changed) text.erase(0, kByteOrderMark.size());
  if (std::optional<std::string> plain = withPlainSections(text)) {
    text = std::move(*plain);
    is_changed = true;
  }
  is_changed = capitalizeExponents(text) || is_changed;
  if (std::optional<std::string> changed = withReadableNumbers(text))
    text = std::move(*changed);
  else if (!is_changed)
    return reader.ReadFile(file.c_str());
  std::istringstream stream(std::move(text));
  return reader.ReadStream(file.c_str(), stream);
}

/// Uses the unit of the settings, or else the millimetre, for a file that states no unit.
void readUnit(const LengthUnits& units, const ImportSettings& settings, RawCad& cad) {
  cad.states_unit = units.is_stated;
  if (!units.remark.empty()) cad.warnings.push_back(units.remark);
  if (units.is_stated) return;
  cad.unit_m = settings.unit_m.value_or(1e-3);
  if (!settings.unit_m)
    cad.warnings.emplace_back(
        "states no unit of length: millimetres are assumed; set unit or --units for another unit");
}

/// The stages of reading STEP and IGES, as shares of the whole that they take (measured roughly).
struct Stage {
  const char* doing;
  double from, to;
};
constexpr Stage kText{"reading the file", 0, 0.1}, kTransfer{"making the faces", 0.1, 0.4},
    kPieces{"", 0.4, 0.5}, kMeshing{"", 0.5, 1};

/// The progress of a stage; `progress` is kept by reference. A stage without a name keeps the names of its
/// work.
Progress within(const Progress& progress, const Stage& stage) {
  if (!progress) return {};
  return [&progress, stage](std::string_view doing, double share) {
    progress(*stage.doing != 0 ? stage.doing : doing, stage.from + (stage.to - stage.from) * share);
  };
}

template <class Reader>
void transfer(Reader& reader, const std::string& file, const FileFormat& format,
              const Handle(TDocStd_Document) & document, const ImportSettings& settings,
              const Progress& progress, RawCad& cad) {
  if (progress) progress(kText.doing, kText.from);
  reader.SetNameMode(true);
  reader.SetColorMode(true);
  if (readText(basic(reader), file, format) != IFSelect_RetDone)
    throw unreadable(file, format, "its syntax is wrong");
  // Open CASCADE 7.6.3 crashes on some entities that were not read, such as a face bound without its loop.
  mendColors(basic(reader).Model());
  const Damage damage = damageOf(basic(reader).Model());
  if (!damage.lost_geometry.empty()) throw unreadable(file, format, damage.lost_geometry);
  if (!damage.remark.empty()) cad.warnings.push_back(damage.remark);
  mendUnits(basic(reader).Model());
  const LengthUnits units = lengthUnits(basic(reader).Model());
  if (!units.fault.empty()) throw unreadable(file, format, units.fault);
  readUnit(units, settings, cad);
  Handle(TDocStd_Document) target = document;
  const Progress tell = within(progress, kTransfer);
  if (tell) tell("", 0);
  const Handle(OcctProgress) stages = new OcctProgress([&](double share) {
    if (tell) tell("", share);
  });
  const bool is_transferred = reader.Transfer(target, stages->Start());
  stages->rethrow();
  if (!is_transferred) throw unreadable(file, format, "no shape could be made from it");
  const LostShapes lost = lostShapes(basic(reader));
  if (!lost.unplaced.empty()) throw unreadable(file, format, lost.unplaced);
  if (!lost.left_out.empty()) cad.warnOfMissing(lost.left_out);
}

void readBrep(const std::string& file, const FileFormat& format, const ImportSettings& settings,
              const Progress& progress, RawCad& cad) {
  cad.unit_m = unitOf(file, format, settings);
  TopoDS_Shape shape;
  if (progress) progress(kText.doing, 0);
  if (!BRepTools::Read(shape, file.c_str(), BRep_Builder()) || shape.IsNull())
    throw unreadable(file, format, "its syntax is wrong");
  const TessellatedShapes found = tessellateAll(pieces(shape), settings, 1 / cad.unit_m, progress);
  for (const TessellatedShape& one : found.shapes) {
    const Tessellation& tessellation = found.tessellations[one.number];
    RawPart part;
    part.mesh = tessellation.mesh;
    part.X_WP = one.X_ST;
    part.deviation_m = errorOf(tessellation, settings);
    part.note = inWords(tessellation, settings);
    cad.parts.push_back(std::move(part));
  }
}

/// Transfers a STEP or IGES file into the document, in millimetres.
void readDocument(const std::string& file, const FileFormat& format, const ImportSettings& settings,
                  const Handle(TDocStd_Document) & document, const Progress& progress, RawCad& cad) {
  cad.unit_m = 1e-3;
  if (format.id == CadFormat::Step) {
    STEPCAFControl_Controller::Init();  // defines the parameter that is set below
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    STEPCAFControl_Reader reader;
    transfer(reader, file, format, document, settings, progress, cad);
  } else {
    IGESControl_Controller::Init();
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    IGESCAFControl_Reader reader;
    transfer(reader, file, format, document, settings, progress, cad);
  }
}

}  // namespace

std::string occtVersion() {
  return OCC_VERSION_STRING_EXT;
}

RawCad readOcct(const std::string& file, const FileFormat& format, const ImportSettings& settings,
                const Progress& tell) {
  std::exception_ptr stop;  // an exception of the callback, which is no fault of the file
  const Progress progress = !tell ? Progress() : [&](std::string_view doing, double share) {
    try {
      tell(doing, share);
    } catch (...) {
      stop = std::current_exception();
      throw;
    }
  };
  static std::mutex one_at_a_time;  // Open CASCADE's settings and messages are global
  const std::lock_guard lock(one_at_a_time);
  const Quiet quiet;
  try {
    RawCad cad;
    if (format.id == CadFormat::Brep) {
      readBrep(file, format, settings, progress, cad);
      return cad;
    }
    Document document;
    readDocument(file, format, settings, document.get(), progress, cad);
    const Progress of_pieces = within(progress, kPieces);
    Tree tree(document.get(), settings, of_pieces, cad);
    tree.addParts(tessellateAll(tree.shapes(), settings, 1 / cad.unit_m, within(progress, kMeshing)));
    return cad;
  } catch (const LoadError&) {
    throw;
  } catch (const Standard_Failure& e) {
    throw unreadable(file, format, e.GetMessageString());
  } catch (const std::exception& e) {
    if (stop) std::rethrow_exception(stop);
    throw unreadable(file, format, e.what());
  }
}

}  // namespace vps::scenes::import
