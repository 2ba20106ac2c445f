// SPDX-License-Identifier: MIT
#include "papilla/core/referenced_file.hpp"

#include <algorithm>
#include <array>
#include <system_error>

#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/read_file.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_quoted = 200;  ///< Bytes of a value in messages.

[[noreturn]] void refuse(const Reference& reference, const std::string& reason) {
  throw InvalidInput(reference.place + ": '" + shown(reference.value.substr(0, k_quoted)) + "' " + reason);
}

/// Whether `path` lies below `folder`; both without "..".
bool is_below(const fs::path& path, const fs::path& folder) {
  const auto [in_folder, in_path] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return (in_folder == folder.end() || in_folder->empty()) && in_path != path.end() && !in_path->empty();
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

}  // namespace

std::optional<fs::path> resolve_reference(const Reference& reference) {
  constexpr const char* k_outside = "leads out of the folder of the file that names it";
  if (reference.value.empty()) return std::nullopt;
  if (reference.value.find('\0') != std::string::npos) refuse(reference, "holds a zero byte");
  std::error_code error;
  const fs::path given = reference.folder.empty() ? fs::path(".") : reference.folder;
  const fs::path folder = fs::canonical(given, error);
  if (error) return std::nullopt;
  // Before links are looked at: whether a file outside exists is nobody's business.
  const fs::path named = folder / reference.value, normal = named.lexically_normal();
  if (!is_below(normal, folder) && !is_below(normal, fs::absolute(given, error).lexically_normal()))
    refuse(reference, k_outside);
  const fs::path file = fs::weakly_canonical(named, error);
  if (error == std::errc::filename_too_long || error == std::errc::not_a_directory) return std::nullopt;
  if (error) refuse(reference, "can't be resolved");
  if (!is_below(file, folder)) refuse(reference, k_outside);
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) return std::nullopt;
  if (!fs::is_regular_file(status)) refuse(reference, "is no regular file");
  return file;
}

std::optional<std::string> read_reference(const Reference& reference, ReferenceContent content) {
  const auto file = resolve_reference(reference);
  if (!file) return std::nullopt;
  std::string bytes = read_file(*file);
  const std::string_view type = picture_mime_type(bytes);
  if (content == ReferenceContent::picture && type.empty()) refuse(reference, "is no picture");
  if (content == ReferenceContent::png && type != "image/png") refuse(reference, "is no PNG picture");
  return bytes;
}

std::string_view picture_mime_type(std::string_view bytes) noexcept {
  struct Signature {
    std::size_t at;
    std::string_view bytes, type;
  };
  static constexpr std::array<Signature, 7> k_signatures = {{{0, "\x89PNG\r\n\x1a\n", "image/png"},
                                                             {0, "\xff\xd8\xff", "image/jpeg"},
                                                             {8, "WEBP", "image/webp"},
                                                             {0, "\xabKTX 20\xbb\r\n\x1a\n", "image/ktx2"},
                                                             {4, "ftypavif", "image/avif"},
                                                             {4, "ftypavis", "image/avif"},
                                                             {0, "DDS ", "image/vnd-ms.dds"}}};
  for (const Signature& s : k_signatures)
    if (bytes.size() >= s.at + s.bytes.size() && bytes.substr(s.at, s.bytes.size()) == s.bytes &&
        (s.type != "image/webp" || bytes.starts_with("RIFF")))
      return s.type;
  return {};
}

std::string percent_decoded(std::string_view uri) {
  std::string path;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool escape = uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 && hex_digit(uri[i + 2]) >= 0;
    path += escape ? static_cast<char>(16 * hex_digit(uri[i + 1]) + hex_digit(uri[i + 2])) : uri[i];
    if (escape) i += 2;
  }
  return path;
}

}  // namespace papilla
