// SPDX-License-Identifier: MIT
#include "scene_stream.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "papilla/core/error.hpp"

namespace papilla::cad {
namespace {

/// Longer lists are nonsense from a broken sender.
constexpr std::uint64_t k_max_bytes = std::uint64_t{1} << 37;

template <class T>
constexpr bool k_plain = std::is_trivially_copyable_v<T>;

/// Sends values in the order in which Receiver takes them.
class Sender {
 public:
  explicit Sender(int pipe) : pipe_(pipe) {}

  template <class T>
  requires k_plain<T>
  void operator()(const T& value) { append(&value, sizeof value); }
  void operator()(const std::string& text) {
    (*this)(static_cast<std::uint64_t>(text.size()));
    append(text.data(), text.size());
  }
  template <class T>
  void operator()(const std::vector<T>& list) {
    (*this)(static_cast<std::uint64_t>(list.size()));
    if constexpr (k_plain<T>)
      append(list.data(), list.size() * sizeof(T));
    else
      for (const T& value : list) visit(*this, value);
  }
  void flush() {
    send_bytes(pipe_, buffer_.data(), buffer_.size());
    buffer_.clear();
  }

 private:
  void append(const void* data, std::size_t size) {
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

  int pipe_;
  std::vector<char> buffer_;
};

class Receiver {
 public:
  explicit Receiver(int pipe) : pipe_(pipe) {}

  template <class T>
  requires k_plain<T>
  void operator()(T& value) { receive_bytes(pipe_, &value, sizeof value); }
  void operator()(std::string& text) {
    text.resize(size_of(1));
    receive_bytes(pipe_, text.data(), text.size());
  }
  template <class T>
  void operator()(std::vector<T>& list) {
    list.resize(size_of(sizeof(T)));
    if constexpr (k_plain<T>)
      receive_bytes(pipe_, list.data(), list.size() * sizeof(T));
    else
      for (T& value : list) visit(*this, value);
  }

 private:
  std::size_t size_of(std::size_t item) {
    std::uint64_t size = 0;
    (*this)(size);
    if (size > k_max_bytes / item) throw IoError("read_cad: the reading process sent a list that is too long");
    return static_cast<std::size_t>(size);
  }

  int pipe_;
};

// One list of fields for both directions. Value is T or const T.

template <class Pipe, class T>
requires k_plain<T> || std::is_same_v<std::remove_const_t<T>, std::string>
void visit(Pipe& pipe, T& value) { pipe(value); }

template <class Pipe, class Value>
void corners(Pipe& pipe, Value& attribute) {
  pipe(attribute.values);
  pipe(attribute.indices);
}

template <class Pipe, class Value>
requires std::is_same_v<std::remove_const_t<Value>, Part>
void visit(Pipe& pipe, Value& part) {
  pipe(part.name), pipe(part.id), pipe(part.materials), pipe(part.extras_json);
  pipe(part.mesh.positions), pipe(part.mesh.triangles), pipe(part.mesh.material), pipe(part.mesh.face);
  corners(pipe, part.mesh.normals);
  corners(pipe, part.mesh.cad_uv);
}

template <class Pipe, class Value>
requires std::is_same_v<std::remove_const_t<Value>, Node>
void visit(Pipe& pipe, Value& node) {
  pipe(node.name), pipe(node.local), pipe(node.children), pipe(node.part), pipe(node.extras_json);
}

template <class Pipe, class Value>
requires std::is_same_v<std::remove_const_t<Value>, Material>
void visit(Pipe& pipe, Value& material) {
  pipe(material.name), pipe(material.base_color), pipe(material.metallic), pipe(material.roughness);
  pipe(material.alpha_mode), pipe(material.extras_json);
}

template <class Pipe, class Value>
requires std::is_same_v<std::remove_const_t<Value>, CadPartReport>
void visit(Pipe& pipe, Value& part) {
  pipe(part.part), pipe(part.max_deviation_mm), pipe(part.max_angle_deg), pipe(part.added_nodes);
}

template <class Pipe, class Value>
requires std::is_same_v<std::remove_const_t<Value>, CadFaceNote>
void visit(Pipe& pipe, Value& note) { pipe(note.part), pipe(note.face), pipe(note.reason), pipe(note.tried); }

template <class Pipe, class Value>
requires std::is_same_v<std::remove_const_t<Value>, Scene>
void visit(Pipe& pipe, Value& scene) {
  pipe(scene.format), pipe(scene.unit), pipe(scene.millimetres_per_unit), pipe(scene.up);
  pipe(scene.parts), pipe(scene.nodes), pipe(scene.roots), pipe(scene.materials);
  pipe(scene.extras_json), pipe(scene.losses), pipe(scene.warnings);
}

template <class Pipe, class Value>
requires std::is_same_v<std::remove_const_t<Value>, CadReport>
void visit(Pipe& pipe, Value& report) {
  pipe(report.solids), pipe(report.faces), pipe(report.triangles), pipe(report.added_nodes);
  pipe(report.dropped_triangles), pipe(report.failed_faces), pipe(report.repaired_faces), pipe(report.off_faces);
  pipe(report.parts), pipe(report.max_deviation_mm), pipe(report.max_angle_deg);
  pipe(report.seconds_read), pipe(report.seconds_tessellate), pipe(report.seconds_convert);
}

}  // namespace

void send_bytes(int pipe, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = ::write(pipe, at, size);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) throw IoError("read_cad: the pipe to the caller is closed");
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
}

void receive_bytes(int pipe, void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = ::read(pipe, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw IoError("read_cad: the reading process ended early");
    at += got;
    size -= static_cast<std::size_t>(got);
  }
}

void send_scene(int pipe, const Scene& scene, const CadReport& report) {
  Sender sender(pipe);
  visit(sender, scene);
  visit(sender, report);
  sender.flush();
}

void receive_scene(int pipe, Scene& scene, CadReport& report) {
  Receiver receiver(pipe);
  visit(receiver, scene);
  visit(receiver, report);
}

}  // namespace papilla::cad
