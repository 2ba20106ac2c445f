// SPDX-License-Identifier: MIT
#include "papilla/io/scene_stream.hpp"

#include <unistd.h>

#include <cerrno>

namespace papilla {
namespace {

// One list of fields for both directions. Value is T or const T.

template <class Value, class T>
concept Is = std::is_same_v<std::remove_const_t<Value>, T>;

template <class Pipe, class Value>
void corners(Pipe& pipe, Value& attribute) {
  pipe(attribute.values);
  pipe(attribute.indices);
}

}  // namespace

// Templates of the namespace, so that the lists of ValueSender and ValueReceiver find them.

template <class Pipe, Is<Part> Value>
void visit_value(Pipe& pipe, Value& part) {
  pipe(part.name), pipe(part.id), pipe(part.materials), pipe(part.extras_json);
  pipe(part.mesh.positions), pipe(part.mesh.triangles), pipe(part.mesh.material), pipe(part.mesh.face);
  corners(pipe, part.mesh.normals);
  corners(pipe, part.mesh.uv);
  corners(pipe, part.mesh.uv1);
  corners(pipe, part.mesh.cad_uv);
  corners(pipe, part.mesh.colors);
}

template <class Pipe, Is<Node> Value>
void visit_value(Pipe& pipe, Value& node) {
  pipe(node.name), pipe(node.local), pipe(node.children), pipe(node.part), pipe(node.extras_json);
}

template <class Pipe, Is<Material> Value>
void visit_value(Pipe& pipe, Value& material) {
  pipe(material.name), pipe(material.base_color), pipe(material.metallic), pipe(material.roughness);
  pipe(material.emissive), pipe(material.double_sided), pipe(material.alpha_mode), pipe(material.alpha_cutoff);
  pipe(material.base_color_texture), pipe(material.metallic_roughness_texture), pipe(material.normal_texture);
  pipe(material.occlusion_texture), pipe(material.emissive_texture);
  pipe(material.extras_json), pipe(material.extensions_json);
}

template <class Pipe, Is<OtherImage> Value>
void visit_value(Pipe& pipe, Value& other) {
  pipe(other.extension), pipe(other.image);
}

template <class Pipe, Is<Texture> Value>
void visit_value(Pipe& pipe, Value& texture) {
  pipe(texture.image), pipe(texture.others), pipe(texture.name), pipe(texture.wrap_s), pipe(texture.wrap_t);
  pipe(texture.min_filter), pipe(texture.mag_filter), pipe(texture.extras_json), pipe(texture.extensions_json);
}

template <class Pipe, Is<EncodedImage> Value>
void visit_value(Pipe& pipe, Value& image) {
  pipe(image.name), pipe(image.mime_type), pipe(image.uri), pipe(image.bytes), pipe(image.extras_json);
}

template <class Pipe, Is<Scene> Value>
void visit_fields(Pipe& pipe, Value& scene) {
  pipe(scene.format), pipe(scene.unit), pipe(scene.millimetres_per_unit), pipe(scene.up);
  pipe(scene.parts), pipe(scene.nodes), pipe(scene.roots);
  pipe(scene.materials), pipe(scene.textures), pipe(scene.images);
  pipe(scene.extras_json), pipe(scene.losses), pipe(scene.warnings);
}

void visit_value(ValueSender& pipe, const Scene& scene) { visit_fields(pipe, scene); }
void visit_value(ValueReceiver& pipe, Scene& scene) { visit_fields(pipe, scene); }

void ValueSender::append(const void* data, std::size_t size) {
  constexpr std::size_t k_large = 1 << 16;
  if (size >= k_large) {
    flush();
    send_bytes(pipe_, data, size);
    return;
  }
  const char* bytes = static_cast<const char*>(data);
  buffer_.insert(buffer_.end(), bytes, bytes + size);
  if (buffer_.size() >= k_large) flush();
}

void ValueSender::flush() {
  send_bytes(pipe_, buffer_.data(), buffer_.size());
  buffer_.clear();
}

std::size_t ValueReceiver::size_of(std::size_t item) {
  constexpr std::uint64_t k_max_bytes = std::uint64_t{1} << 37;
  std::uint64_t size = 0;
  (*this)(size);
  if (size > k_max_bytes / item) throw IoError("the reading process sent a list that is too long");
  return static_cast<std::size_t>(size);
}

void send_bytes(int pipe, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = ::write(pipe, at, size);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) throw IoError("the pipe to the caller is closed");
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
}

void receive_bytes(int pipe, void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = ::read(pipe, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw IoError("the reading process ended early");
    at += got;
    size -= static_cast<std::size_t>(got);
  }
}

}  // namespace papilla
