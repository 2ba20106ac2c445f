// SPDX-License-Identifier: MIT
#include "cad_document.hpp"

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPConstruct_ExternRefs.hxx>
#include <STEPControl_Reader.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopoDS_Shape.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

#include "cad_syntax.hpp"
#include "occt_session.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/referenced_file.hpp"

namespace papilla::cad {
namespace {

enum class Kind { step, iges, text_brep, binary_brep };

struct FileEnds {
  std::string head, tail;
};

constexpr std::streamoff k_end_bytes = 4096;

FileEnds read_ends(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw IoError(path.string() + ": is a directory");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(path.string() + ": can't be opened");
  file.seekg(0, std::ios::end);
  const std::streamoff size = file.tellg();
  if (size < 0) throw IoError(path.string() + ": can't be read");
  if (size == 0) throw InvalidInput(path.string() + ": the file is empty");
  const auto read_at = [&](std::streamoff from) {
    std::string text(static_cast<std::size_t>(std::min(size, k_end_bytes)), '\0');
    file.seekg(from);
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!file) throw IoError(path.string() + ": can't be read");
    return text;
  };
  return {read_at(0), read_at(std::max<std::streamoff>(0, size - k_end_bytes))};
}

std::string_view trimmed_front(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
  return text;
}

/// IGES: lines of 72 columns, then the section's letter and the line's number.
bool is_iges_line(std::string_view line, char section) {
  return line.size() >= 80 && line[72] == section &&
         std::all_of(line.begin() + 73, line.begin() + 80, [](unsigned char c) { return std::isdigit(c) || c == ' '; });
}

std::string_view last_line(std::string_view text) {
  while (!text.empty() && (std::isspace(static_cast<unsigned char>(text.back())) || text.back() == '\0'))
    text.remove_suffix(1);
  const std::size_t start = text.find_last_of("\r\n");
  return start == std::string_view::npos ? text : text.substr(start + 1);
}

bool has_line_starting(std::string_view text, std::string_view start) {
  for (std::size_t at = text.find(start); at != std::string_view::npos; at = text.find(start, at + 1))
    if (at == 0 || text[at - 1] == '\n') return true;
  return false;
}

Kind kind_of(const std::filesystem::path& path, const FileEnds& ends) {
  const std::string_view head = trimmed_front(ends.head);
  if (head.starts_with("ISO-10303-21")) {
    if (ends.tail.find("END-ISO-10303-21") == std::string::npos)
      throw InvalidInput(path.string() + ": STEP file is truncated (no END-ISO-10303-21 at its end)");
    return Kind::step;
  }
  if (is_iges_line(ends.head, 'S')) {
    std::string terminate(last_line(ends.tail));
    terminate.resize(std::max<std::size_t>(terminate.size(), 80), ' ');
    if (!is_iges_line(terminate, 'T'))
      throw InvalidInput(path.string() + ": IGES file is truncated (its last line is not of section T)");
    return Kind::iges;
  }
  // OpenCASCADE skips all lines before the one with the version, such as DRAW's DBRep_DrawableShape.
  if (has_line_starting(head, "CASCADE Topology V")) return Kind::text_brep;
  if (has_line_starting(head, "Open CASCADE Topology V")) return Kind::binary_brep;
  throw InvalidInput(path.string() + ": neither STEP, IGES nor BREP (unknown first bytes)");
}

/// The library's readers keep their parameters in global variables: set all that matter, every time.
void set_reader_parameters() {
  STEPCAFControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  Interface_Static::SetIVal("read.step.product.mode", 1);
  Interface_Static::SetIVal("read.step.assembly.level", 1);
  Interface_Static::SetIVal("read.step.shape.repr", 1);
  Interface_Static::SetIVal("read.step.nonmanifold", 0);
  Interface_Static::SetCVal("read.step.codepage", "UTF8");
  Interface_Static::SetIVal("read.stepcaf.subshapes.name", 1);
  Interface_Static::SetIVal("read.precision.mode", 0);
  Interface_Static::SetIVal("read.surfacecurve.mode", 0);
}

struct LengthUnit {
  std::string name;
  double millimetres;
};

/// The unit under the name the rest of the toolkit uses; unknown names pass through with factor 1.
LengthUnit length_unit(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  struct Known {
    std::string_view begins;
    LengthUnit unit;
  };
  static const std::array<Known, 7> known = {{{"millimet", {"mm", 1}},
                                              {"centimet", {"cm", 10}},
                                              {"micromet", {"um", 1e-3}},
                                              {"kilomet", {"km", 1e6}},
                                              {"met", {"m", 1000}},
                                              {"inch", {"inch", 25.4}},
                                              {"f", {"ft", 304.8}}}};
  for (const Known& entry : known)
    if (name.starts_with(entry.begins)) return entry.unit;
  return {name.empty() ? "mm" : name, 1};
}

/// OpenCASCADE reads the files that a STEP file names (AP214's external references), and those that they name: all must
/// lie in the folder of the file that names them, or below it.
/// @param chain  the files on the way here; the last one is the session's.
/// @param seen   files that were looked at.
/// @throws InvalidInput as resolve_reference(), and when files name each other in a circle.
void check_external_references(std::vector<std::filesystem::path>& chain, std::set<std::filesystem::path>& seen,
                               const Handle(XSControl_WorkSession) & session) {
  STEPConstruct_ExternRefs references(session);
  references.LoadExternRefs();
  for (int i = 1; i <= references.NbExternRefs(); ++i) {
    const char* const name = references.FileName(i);
    if (name == nullptr) continue;
    const std::filesystem::path naming = chain.back();
    const std::string place = naming.string() + ": external reference " + std::to_string(i);
    const auto file = resolve_reference({naming.parent_path(), place, name});
    if (!file) continue;
    if (std::find(chain.begin(), chain.end(), *file) != chain.end())
      throw InvalidInput(place + ": '" + shown(name) + "' names itself or a file that names it");
    if (!seen.insert(*file).second) continue;
    STEPControl_Reader reader(new XSControl_WorkSession, Standard_False);
    if (reader.ReadFile(file->c_str()) != IFSelect_RetDone) continue;  // Files of other kinds stay unread.
    chain.push_back(*file);
    check_external_references(chain, seen, reader.WS());
    chain.pop_back();
  }
}

void read_step(const std::filesystem::path& path, CadDocument& result, const ProgressCallback& progress) {
  STEPCAFControl_Reader reader;
  reader.SetNameMode(true);
  reader.SetColorMode(true);
  reader.SetLayerMode(true);
  reader.SetMatMode(true);
  reader.SetPropsMode(true);
  reader.SetGDTMode(true);
  reader.SetViewMode(true);
  check_step_syntax(path);
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone)
    throw InvalidInput(path.string() + ": STEP file is damaged (its entities can't be parsed)");
  std::vector<std::filesystem::path> chain{std::filesystem::canonical(path)};
  std::set<std::filesystem::path> seen;
  check_external_references(chain, seen, reader.ChangeReader().WS());
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.ChangeReader().FileUnits(lengths, angles, solid_angles);
  if (!lengths.IsEmpty()) {
    const LengthUnit unit = length_unit(lengths.First().ToCString());
    result.unit = unit.name;
    result.millimetres_per_unit = unit.millimetres;
  }
  const Handle(OcctProgress) indicator = new OcctProgress(progress, "read", 0, 0.3);
  if (!reader.Transfer(result.document, indicator->Start()))
    throw InvalidInput(path.string() + ": STEP file holds no shape that can be read");
  result.metadata = read_step_metadata(reader, result.document);
}

void read_iges(const std::filesystem::path& path, CadDocument& result, const ProgressCallback& progress) {
  IGESCAFControl_Reader reader;
  reader.SetNameMode(true);
  reader.SetColorMode(true);
  reader.SetLayerMode(true);
  check_iges_syntax(path);
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone)
    throw InvalidInput(path.string() + ": IGES file is damaged (its sections can't be parsed)");
  const Handle(TCollection_HAsciiString) unit_name = reader.IGESModel()->GlobalSection().UnitName();
  result.millimetres_per_unit = reader.IGESModel()->GlobalSection().UnitValue();
  result.unit = unit_name.IsNull() ? "mm (assumed)" : unit_name->ToCString();
  std::transform(result.unit.begin(), result.unit.end(), result.unit.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const Handle(OcctProgress) indicator = new OcctProgress(progress, "read", 0, 0.3);
  if (!reader.Transfer(result.document, indicator->Start()))
    throw InvalidInput(path.string() + ": IGES file holds no shape that can be read");
}

void read_brep(const std::filesystem::path& path, bool is_binary, CadDocument& result) {
  TopoDS_Shape shape;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(path.string() + ": can't be opened");
  // The library does not check that its reads succeed: it would loop as often as a damaged number says.
  file.exceptions(std::ios::failbit | std::ios::badbit);
  try {
    if (is_binary)
      BinTools::Read(shape, file);
    else
      BRepTools::Read(shape, file, BRep_Builder());
  } catch (const std::ios::failure&) {
    throw InvalidInput(path.string() + ": BREP file is damaged (it ends early or has text where a number belongs)");
  }
  if (shape.IsNull()) throw InvalidInput(path.string() + ": BREP file is damaged or truncated (no shape in it)");
  XCAFDoc_DocumentTool::ShapeTool(result.document->Main())->AddShape(shape, shape.ShapeType() == TopAbs_COMPOUND);
}

}  // namespace

CadDocument read_document(const std::filesystem::path& path, const ProgressCallback& progress) {
  const Kind kind = kind_of(path, read_ends(path));
  set_reader_parameters();
  CadDocument result;
  result.document = new TDocStd_Document("BinXCAF");
  XCAFDoc_DocumentTool::Set(result.document->Main());
  switch (kind) {
    case Kind::step:
      result.format = "STEP";
      read_step(path, result, progress);
      break;
    case Kind::iges:
      result.format = "IGES";
      read_iges(path, result, progress);
      break;
    case Kind::text_brep:
    case Kind::binary_brep:
      result.format = "BREP";
      read_brep(path, kind == Kind::binary_brep, result);
      break;
  }
  return result;
}

}  // namespace papilla::cad
