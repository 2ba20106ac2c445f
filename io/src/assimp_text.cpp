// SPDX-License-Identifier: MIT
#include "assimp_text.hpp"

#include <fmt/core.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/units.hpp"

namespace papilla {
namespace {

/// Little-endian numbers of a ZIP archive.
class ZipBytes {
 public:
  explicit ZipBytes(std::string_view bytes) : bytes_(bytes) {}

  std::uint64_t number(std::size_t at, std::size_t size) const {
    std::uint64_t value = 0;
    for (std::size_t i = size; i-- > 0;) value = value << 8 | static_cast<unsigned char>(piece(at, size)[i]);
    return value;
  }
  std::string_view piece(std::size_t at, std::size_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) throw InvalidInput("the package ends early");
    return bytes_.substr(at, size);
  }
  std::size_t size() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
};

/// APPNOTE.TXT 6.3.10, 4.3.12: a file's entry in the central directory.
struct ZipEntry {
  std::string_view name;
  std::uint64_t method = 0, packed = 0, unpacked = 0, header = 0;
};

std::vector<ZipEntry> entries_of(const ZipBytes& zip, std::string_view package) {
  const std::size_t end = package.rfind("PK\5\6");
  if (end == std::string_view::npos) throw InvalidInput("is no 3MF package (a ZIP archive)");
  std::vector<ZipEntry> entries;
  const std::uint64_t count = zip.number(end + 10, 2);
  std::size_t at = zip.number(end + 16, 4);
  for (std::uint64_t i = 0; i < count; ++i) {
    if (zip.piece(at, 4) != "PK\1\2") throw InvalidInput("the package's list of files is damaged");
    const std::size_t name = zip.number(at + 28, 2);
    entries.push_back({zip.piece(at + 46, name), zip.number(at + 10, 2), zip.number(at + 20, 4), zip.number(at + 24, 4),
                       zip.number(at + 42, 4)});
    at += 46 + name + zip.number(at + 30, 2) + zip.number(at + 32, 2);
  }
  return entries;
}

std::string unpack(const ZipBytes& zip, const ZipEntry& entry) {
  const std::size_t names = zip.number(entry.header + 26, 2) + zip.number(entry.header + 28, 2);
  const std::string_view packed = zip.piece(entry.header + 30 + names, entry.packed);
  if (entry.method == 0) return std::string(packed);
  // Deflate makes no more than 1032 bytes of one.
  constexpr std::uint64_t k_max_ratio = 1032;
  if (entry.method != Z_DEFLATED || entry.unpacked > k_max_ratio * entry.packed)
    throw InvalidInput("the model in the package is packed in an unknown way");
  std::string text(entry.unpacked, '\0');
  z_stream stream{};
  if (::inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw InvalidInput("the package can't be unpacked");
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(text.data());
  stream.avail_out = static_cast<uInt>(text.size());
  const int result = ::inflate(&stream, Z_FINISH);
  ::inflateEnd(&stream);
  if (result != Z_STREAM_END || stream.avail_out != 0) throw InvalidInput("the model in the package is damaged");
  return text;
}

/// Start tags of an element, "<name", whose text holds `attribute`.
std::size_t count_tags(std::string_view text, std::string_view element, std::string_view attribute = {}) {
  std::size_t count = 0;
  for (std::size_t at = text.find(element); at != std::string_view::npos; at = text.find(element, at + 1)) {
    const std::string_view rest = text.substr(at + element.size());
    const bool ends_here = rest.empty() || std::string_view(" \t\r\n/>").find(rest.front()) != std::string_view::npos;
    if (ends_here && rest.substr(0, rest.find('>')).find(attribute) != std::string_view::npos) ++count;
  }
  return count;
}

std::size_t count_text(std::string_view text, std::string_view wanted) {
  std::size_t count = 0;
  for (std::size_t at = text.find(wanted); at != std::string_view::npos; at = text.find(wanted, at + wanted.size()))
    ++count;
  return count;
}

}  // namespace

std::string unpack_3mf_model(std::string_view package) {
  const ZipBytes zip(package);
  const std::vector<ZipEntry> entries = entries_of(zip, package);
  auto model = std::find_if(entries.begin(), entries.end(),
                            [](const ZipEntry& entry) { return entry.name == "3D/3dmodel.model"; });
  if (model == entries.end())
    model = std::find_if(entries.begin(), entries.end(),
                         [](const ZipEntry& entry) { return entry.name.ends_with(".model"); });
  if (model == entries.end()) throw InvalidInput("the package holds no model");
  return unpack(zip, *model);
}

double millimetres_of_3mf(std::string_view model) {
  constexpr std::pair<std::string_view, double> k_units[] = {{"micron", 1e-3},
                                                             {"millimeter", 1},
                                                             {"centimeter", 10},
                                                             {"inch", k_mm_per_inch},
                                                             {"foot", 12 * k_mm_per_inch},
                                                             {"meter", k_mm_per_metre}};
  const std::size_t tag = model.find("<model");
  const std::string_view attributes =
      tag == std::string_view::npos ? std::string_view() : model.substr(tag, model.find('>', tag) - tag);
  for (const char quote : {'"', '\''}) {
    const std::string key = std::string(" unit=") + quote;
    const std::size_t at = attributes.find(key);
    if (at == std::string_view::npos) continue;
    const std::string_view rest = attributes.substr(at + key.size());
    const std::string_view value = rest.substr(0, rest.find(quote));
    for (const auto& [name, millimetres] : k_units)
      if (name == value) return millimetres;
    throw InvalidInput("the unit '" + printable(value) + "' is none of 3MF's");
  }
  return 1;
}

std::string x3d_for_assimp(std::string_view text) {
  std::string result;
  result.reserve(text.size() + text.size() / 64);
  while (!text.empty()) {
    const std::size_t plain = text.find("='\""), escaped = text.find("=\"&quot;");
    const std::size_t at = std::min(plain, escaped);
    if (at == std::string_view::npos) break;
    const char end = at == plain ? '\'' : '"';
    const std::string_view quote = at == plain ? "\"" : "&quot;";
    const std::size_t value = at + 2;
    const std::size_t behind = std::min(text.find(end, value), text.size());
    result += text.substr(0, value);
    bool is_open = false;
    for (std::size_t i = value; i < behind;) {
      const bool is_quote = text.substr(i, quote.size()) == quote;
      if (is_quote && is_open) result += ' ';
      if (is_quote) is_open = !is_open;
      const std::size_t length = is_quote ? quote.size() : 1;
      result += text.substr(i, length);
      i += length;
    }
    text.remove_prefix(behind);
  }
  result += text;
  for (std::size_t at = result.find("Inline"); at != std::string::npos; at = result.find("Inline", at))
    if (at > 0 && (result[at - 1] == '<' || result[at - 1] == '/'))
      result.replace(at, 6, "WorldInfo");
    else
      at += 6;
  return result;
}

std::vector<std::string> unread_by_assimp(std::string_view extension, std::string_view text, std::size_t meshes) {
  std::vector<std::string> lines;
  const auto note = [&](std::size_t count, const char* what) {
    if (count > 0) lines.push_back(fmt::format("{} {}", count, what));
  };
  if (extension == ".3mf") {
    note(count_tags(text, "<triangle", " pid="),
         "triangles with a material of their own (a mesh has that of the last)");
    note(count_tags(text, "<m:texture2dgroup") + count_tags(text, "<texture2dgroup"), "groups of texture coordinates");
    note(count_tags(text, "<m:colorgroup") + count_tags(text, "<colorgroup"), "groups of colours");
    note(count_tags(text, "<component", ":path=") + count_tags(text, "<item", ":path="),
         "objects in further model files");
    note(count_tags(text, "<object", " name="), "names of objects");
  } else if (extension == ".x3d") {
    const std::size_t shapes = count_tags(text, "<Shape") - count_tags(text, "<Shape", " USE=");
    if (shapes > meshes) lines.push_back(fmt::format("{} of {} shapes", shapes - meshes, shapes));
    note(count_tags(text, "<Inline"), "files that it includes");
    note(count_tags(text, "<ProtoInstance"), "instances of prototypes");
    note(count_tags(text, "<Group", " USE=") + count_tags(text, "<Transform", " USE="),
         "repeated groups (USE), behind which assimp may lose nodes");
    note(count_text(text, " USE="), "repeated nodes (USE) that are written out once more");
  } else if (extension == ".dae") {
    note(count_tags(text, "<spline") + count_tags(text, "<nurbs") + count_tags(text, "<brep"), "splines and NURBS");
  } else if (extension == ".ac") {
    note(count_text(text, "\nsubdiv "), "subdivisions of objects");
    note(count_text(text, "\nrot "), "rotations (objects that are turned and moved may stand elsewhere)");
  } else if (extension == ".fbx") {
    if (text.find("NurbsSurface") != std::string_view::npos || text.find("NurbsCurve") != std::string_view::npos)
      lines.push_back("NURBS surfaces and curves");
  } else if (extension == ".blend") {
    lines.push_back(
        "of Blender: curves, texts, metaballs, linked collections, modifiers and node materials, where there are any");
  }
  return lines;
}

}  // namespace papilla
