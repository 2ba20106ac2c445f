// SPDX-License-Identifier: MIT
#include "gltf_side_files.hpp"

#include <fstream>
#include <iterator>
#include <optional>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/referenced_file.hpp"
#include "papilla/io/named_files.hpp"
#include "text_scanner.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// What stands at the place of an output; unlike read_file() it makes no input of it.
std::optional<std::string> present_content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(in), {});
}

std::string plain(const std::string& name) {
  std::string text;
  for (const char c : name) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
                          c == '_' || (c == '.' && !text.empty());
    text += is_plain ? c : '_';
  }
  return text.empty() ? "_" : text;
}

std::string extension_of(const std::string& mime_type) {
  const std::size_t slash = mime_type.find('/');
  const std::string kind = slash == std::string::npos ? "" : mime_type.substr(slash + 1);
  return kind == "jpeg" ? ".jpg" : kind.empty() ? "" : "." + plain(kind);
}

/// Without recursion: a former output may be nested as deep as it is long.
template <class AnyJson>
void collect(const AnyJson& json, std::set<std::string>& uris) {
  std::vector<const AnyJson*> waiting{&json};
  while (!waiting.empty()) {
    const AnyJson& part = *waiting.back();
    waiting.pop_back();
    if (part.is_object())
      if (const auto uri = part.find("uri"); uri != part.end() && uri->is_string()) {
        const std::string& text = uri->template get_ref<const std::string&>();
        if (text.find(':') == std::string::npos) uris.insert(percent_decoded(text));
      }
    if (part.is_structured())
      for (const AnyJson& child : part) waiting.push_back(&child);
  }
}

}  // namespace

bool is_gltf_with_files(const fs::path& output) { return equals_ignoring_case(output.extension().string(), ".gltf"); }

void collect_uris(const Json& json, std::set<std::string>& uris) { collect(json, uris); }

std::set<std::string> named_files(const fs::path& gltf) {
  std::set<std::string> files;
  if (!is_gltf_with_files(gltf)) return files;
  const auto text = present_content(gltf);
  // Unlike ordered_json, whose objects copy their members when they grow, this one is parsed without recursion.
  if (text) collect(nlohmann::json::parse(*text, nullptr, false), files);
  return files;
}

std::uintmax_t size_with_named_files(const fs::path& file) {
  std::uintmax_t size = fs::file_size(file);
  for (const std::string& name : named_files(file)) {
    std::error_code error;
    const std::uintmax_t own = fs::file_size(file.parent_path() / name, error);
    if (!error) size += own;
  }
  return size;
}

GltfSideFiles::GltfSideFiles(fs::path output) : output_(std::move(output)) {
  taken_.insert(output_.filename().string());
}

void GltfSideFiles::copy(const std::string& relative, const fs::path& source) {
  const fs::path place = fs::path(relative).lexically_normal();
  if (place.is_absolute() || place.begin() == place.end() || *place.begin() == "..")
    throw InvalidInput(output_.string() + ": '" + one_line(relative) + "' would lie outside of its folder");
  taken_.insert(place.string());
  copied_[place.string()] = source;
}

std::string GltfSideFiles::add(const std::string& stem, const std::string& extension, std::string bytes) {
  std::string name = stem + extension;
  for (int i = 2; !taken_.insert(name).second; ++i) name = stem + "-" + std::to_string(i) + extension;
  added_[name] = std::move(bytes);
  return name;
}

std::string GltfSideFiles::add_picture(const EncodedImage& image) {
  const std::string stem = plain(output_.stem().string());
  constexpr std::size_t k_longest = 64;  // File systems take 255 bytes, of which the stem is the user's.
  const std::string name = image.name.empty() ? "" : "-" + plain(image.name).substr(0, k_longest);
  return add(stem + name, extension_of(image.mime_type),
             {reinterpret_cast<const char*>(image.bytes.data()), image.bytes.size()});
}

std::string GltfSideFiles::add_binary(std::string bytes) {
  return add(plain(output_.stem().string()), ".bin", std::move(bytes));
}

bool GltfSideFiles::is_new(const std::string& name, const std::string& bytes,
                           const std::set<std::string>& former) const {
  const fs::path place = output_.parent_path() / name;
  const auto present = present_content(place);
  if (!present) return true;
  if (*present == bytes) return false;
  if (!former.contains(name))
    throw IoError(place.string() + ": exists with other content and may belong to another scene; " +
                  output_.filename().string() + " would replace it: write into another folder");
  return true;
}

void GltfSideFiles::write() const {
  const std::set<std::string> former = named_files(output_);
  std::vector<std::string> copied, added;  // All are looked at before the first is written.
  for (const auto& [name, source] : copied_) {
    std::error_code error;
    if (!fs::equivalent(output_.parent_path() / name, source, error) && is_new(name, read_file(source), former))
      copied.push_back(name);
  }
  for (const auto& [name, bytes] : added_)
    if (is_new(name, bytes, former)) added.push_back(name);
  const auto write_one = [&](const std::string& name, const std::string& bytes) {
    const fs::path place = output_.parent_path() / name;
    if (place.has_parent_path()) make_folder(place.parent_path());
    write_atomically(place, bytes);
  };
  for (const std::string& name : copied) write_one(name, read_file(copied_.at(name)));
  for (const std::string& name : added) write_one(name, added_.at(name));
}

}  // namespace papilla
