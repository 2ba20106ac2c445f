// SPDX-License-Identifier: MIT
#include "stl_binary.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"
#include "papilla/io/vertex_welder.hpp"

namespace papilla {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is read in place");

constexpr std::size_t k_normal_size = 12, k_color_at = 48;
constexpr std::size_t k_block = 1024;  ///< Triangles read at once: 50 kB, which stay in the second-level cache.

/// What the two bytes behind each triangle mean. Both ways use 5 bits a channel.
/// Source: https://en.wikipedia.org/wiki/STL_(file_format)#Color_in_binary_STL
class AttributeColors {
 public:
  /// Materialise's header holds "COLOR=" and the object's colour as four bytes.
  explicit AttributeColors(std::string_view head) {
    const std::size_t at = head.substr(0, 80).find("COLOR=");
    if (at == std::string_view::npos || at + 10 > 80) return;
    is_materialise_ = true;
    for (std::size_t i = 0; i < 4; ++i) object_[i] = static_cast<std::uint8_t>(head[at + 6 + i]);
  }

  void add(std::size_t triangle, std::uint16_t code) {
    if (codes_.empty()) {
      if (!has_color(code)) return;
      codes_.resize(triangle, is_materialise_ ? k_valid : 0);
    }
    codes_.push_back(code);
  }

  /// Triangles without a colour of their own get the object's, or white.
  CornerAttribute<Color> colors() const {
    CornerAttribute<Color> result;
    if (codes_.empty()) return result;
    std::vector<Index> number_of_code(std::size_t{1} << 16, k_no_value);
    result.indices.reserve(codes_.size());
    for (const std::uint16_t code : codes_) {
      Index& number = number_of_code[code];
      if (number == k_no_value) {
        number = static_cast<Index>(result.values.size());
        result.values.push_back(color_of(code));
      }
      result.indices.push_back({number, number, number});
    }
    return result;
  }

 private:
  static constexpr std::uint16_t k_valid = 0x8000;

  /// VisCAM sets the top bit of triangles with a colour, Materialise of those without.
  bool has_color(std::uint16_t code) const { return ((code & k_valid) != 0) != is_materialise_; }

  Color color_of(std::uint16_t code) const {
    const auto linear = [](double x) { return static_cast<float>(linear_from_srgb(x)); };
    const auto channel = [&](int shift) { return linear((code >> shift & 31) / 31.0); };
    if (has_color(code) && is_materialise_) return {channel(0), channel(5), channel(10), 1};
    if (has_color(code)) return {channel(10), channel(5), channel(0), 1};
    return {linear(object_[0] / 255.0), linear(object_[1] / 255.0), linear(object_[2] / 255.0),
            static_cast<float>(object_[3]) / 255};
  }

  bool is_materialise_ = false;
  std::array<std::uint8_t, 4> object_{255, 255, 255, 255};
  std::vector<std::uint16_t> codes_;  ///< Empty while no triangle had a colour.
};

/// Unpacks records and welds their corners.
class BlockReader {
 public:
  BlockReader(std::string_view head, std::uint64_t triangles, double unit, const std::string& file)
      : file_(file), unit_(unit), welder_(triangles / 2), colors_(head) {
    mesh_.triangles.resize(triangles);
    corners_.reserve(3 * k_block);
    numbers_.resize(3 * k_block);
  }

  void add(std::string_view records) {
    corners_.clear();
    const std::size_t count = records.size() / k_stl_record_size;
    for (std::size_t i = 0; i < count; ++i) unpack(records.data() + k_stl_record_size * i, done_ + i);
    welder_.add(corners_, std::span(numbers_).first(corners_.size()));
    std::memcpy(mesh_.triangles.data() + done_, numbers_.data(), count * sizeof(Triangle));
    done_ += count;
  }

  TriangleMesh finish() {
    mesh_.positions = welder_.take_points();
    mesh_.colors = colors_.colors();
    return std::move(mesh_);
  }

 private:
  void unpack(const char* record, std::size_t triangle) {
    std::array<float, 9> numbers;
    std::memcpy(numbers.data(), record + k_normal_size, sizeof numbers);
    for (std::size_t k = 0; k < 9; k += 3) {
      const Vec3 point{double{numbers[k]}, double{numbers[k + 1]}, double{numbers[k + 2]}};
      if (!is_finite(point))
        throw InvalidInput(file_ + ": triangle " + std::to_string(triangle) + ": a coordinate is not finite");
      corners_.push_back(unit_ * point);
    }
    std::uint16_t code;
    std::memcpy(&code, record + k_color_at, sizeof code);
    colors_.add(triangle, code);
  }

  const std::string& file_;
  double unit_;
  TriangleMesh mesh_;
  VertexWelder welder_;
  AttributeColors colors_;
  std::vector<Vec3> corners_;
  std::vector<Index> numbers_;
  std::size_t done_ = 0;
};

}  // namespace

std::uint64_t stl_declared_triangles(std::string_view head) {
  std::uint32_t count = 0;
  std::memcpy(&count, head.data() + 80, sizeof count);
  return count;
}

Part read_binary_stl(const std::filesystem::path& path, std::string_view head, std::uint64_t size, double unit,
                     std::vector<std::string>& warnings) {
  const std::string file = path.string();
  if (size < k_stl_header_size)
    throw InvalidInput(file + ": truncated: an STL header has 84 bytes, the file " + std::to_string(size));
  const std::uint64_t count = stl_declared_triangles(head);
  const std::uint64_t present = (size - k_stl_header_size) / k_stl_record_size;
  if (present < count)
    throw InvalidInput(file + ": truncated: " + std::to_string(count) + " triangles promised, " +
                       std::to_string(present) + " found");
  if (const std::uint64_t surplus = size - k_stl_header_size - k_stl_record_size * count; surplus > 0)
    warnings.push_back(std::to_string(surplus) + " bytes behind the last triangle are ignored");

  BlockReader reader(head, count, unit, file);
  std::ifstream in(path, std::ios::binary);
  in.seekg(k_stl_header_size);
  std::string block(k_block * k_stl_record_size, '\0');
  for (std::uint64_t left = count; left > 0;) {
    const std::size_t bytes = std::min<std::uint64_t>(left, k_block) * k_stl_record_size;
    if (!in.read(block.data(), static_cast<std::streamsize>(bytes))) throw IoError(file + ": cannot be read");
    reader.add(std::string_view(block).substr(0, bytes));
    left -= bytes / k_stl_record_size;
  }
  Part part;
  part.mesh = reader.finish();
  return part;
}

}  // namespace papilla
