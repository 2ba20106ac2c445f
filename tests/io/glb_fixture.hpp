// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace papilla::test {

/// Binary content and the JSON of its bufferViews and accessors.
class GlbFixture {
 public:
  template <class T>
  int view(const std::vector<T>& values, const std::string& more = "") {
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
    views_ += (views_.empty() ? "" : ",") + std::string(R"({"buffer":0,"byteOffset":)") +
              std::to_string(bytes_.size()) + R"(,"byteLength":)" + std::to_string(values.size() * sizeof(T)) + more +
              "}";
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return view_count_++;
  }

  int accessor(int view, int component_type, std::size_t count, const std::string& type, const std::string& more = "") {
    accessors_ += (accessors_.empty() ? "" : ",") + std::string("{") +
                  (view >= 0 ? R"("bufferView":)" + std::to_string(view) + "," : "") + R"("componentType":)" +
                  std::to_string(component_type) + R"(,"count":)" + std::to_string(count) + R"(,"type":")" + type +
                  "\"" + more + "}";
    return accessor_count_++;
  }

  int positions(const std::vector<float>& values) { return accessor(view(values), 5126, values.size() / 3, "VEC3"); }

  /// A view without bytes of its own, described by `json`.
  int described_view(const std::string& json) {
    views_ += (views_.empty() ? "" : ",") + json;
    return view_count_++;
  }

  /// Buffers behind the binary chunk.
  void add_buffer(const std::string& json) { more_buffers_ += "," + json; }

  /// Where the next view will begin.
  std::size_t next_offset() const { return (bytes_.size() + 3) / 4 * 4; }

  /// The GLB with these further members of the root, each followed by a comma.
  std::string glb(const std::string& members) const {
    std::string json = "{" + members + R"("asset":{"version":"2.0"},"bufferViews":[)" + views_ + R"(],"accessors":[)" +
                       accessors_ + R"(],"buffers":[{"byteLength":)" + std::to_string(bytes_.size()) + "}" +
                       more_buffers_ + "]}";
    std::string bin = bytes_;
    json.resize((json.size() + 3) / 4 * 4, ' ');
    bin.resize((bin.size() + 3) / 4 * 4, '\0');
    return "glTF" + word(2) + word(12 + 8 + json.size() + 8 + bin.size()) + word(json.size()) + "JSON" + json +
           word(bin.size()) + std::string("BIN\0", 4) + bin;
  }

  static std::string word(std::size_t value) {
    const auto narrow = static_cast<std::uint32_t>(value);
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &narrow, 4);
    return bytes;
  }

 private:
  std::string bytes_, views_, accessors_, more_buffers_;
  int view_count_ = 0, accessor_count_ = 0;
};

inline std::string mesh_of(const std::string& primitive) {
  return R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[)" + primitive + "]}],";
}

/// (i, 0, 0) metres, so that a position tells its vertex number.
inline std::vector<float> row_of_points(int count) {
  std::vector<float> values;
  for (int i = 0; i < count; ++i) values.insert(values.end(), {float(i), 0, 0});
  return values;
}

}  // namespace papilla::test
