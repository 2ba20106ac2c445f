// SPDX-License-Identifier: MIT
#include "obj_content.hpp"

#include <fmt/core.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <memory>
#include <set>
#include <utility>

#include "obj_block.hpp"
#include "papilla/core/error.hpp"

namespace papilla::io_detail {
namespace {

constexpr std::size_t k_block_bytes = std::size_t{1} << 19;

/// Cuts whole lines off the front of `text`, about a block of them; a line that goes on in the next is not whole.
std::string_view cut_block(std::string_view& text) {
  std::size_t end = std::min(k_block_bytes, text.size());
  while (end < text.size()) {
    end = std::min(text.find('\n', end), text.size() - 1) + 1;
    std::string_view line = text.substr(0, end - 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!line.ends_with('\\')) break;
  }
  const std::string_view block = text.substr(0, end);
  text.remove_prefix(end);
  return block;
}

/// Puts blocks one behind the other.
class ObjAssembly {
 public:
  explicit ObjAssembly(const std::string& file) : file_(file) {
    now_ = {content_.objects.number(""), content_.groups.number(""), content_.materials.number("")};
  }

  /// For positions and faces as many as there are lines that begin with them: growing lists take twice their memory.
  void make_room(std::string_view text) {
    std::size_t positions = 0, faces = 0;
    for (std::size_t at = 0; at < text.size(); at = std::min(text.find('\n', at), text.size()) + 1) {
      const std::string_view line = text.substr(at, 2);
      positions += line == "v ";
      faces += line == "f ";
    }
    content_.positions.reserve(positions);
    content_.faces.reserve(faces);
    content_.corners.reserve(3 * faces);
  }

  void append(ObjBlock block) {
    for (const ObjBackwardIndex& index : block.backward) place(index, block.content.corners);
    if (block.fault) fail(block.fault->line, block.fault->reason);
    append_faces(block);
    append_elements(block.content);
    for (ObjLibrary& library : block.content.libraries)
      content_.libraries.push_back({std::move(library.names), lines_ + library.line});
    add(short_faces_, block.short_faces);
    add(bad_normals_, block.bad_normals);
    add(bad_colors_, block.bad_colors);
    losses_.merge(block.losses);
    lines_ += block.lines;
  }

  ObjContent finish(Scene& scene) {
    const auto warn_of = [&](const char* what, const ObjOddity& oddity) {
      if (oddity.count > 0)
        scene.warnings.push_back(fmt::format("{} {} (first in line {})", oddity.count, what, oddity.line));
    };
    warn_of("faces of fewer than three corners are ignored", short_faces_);
    warn_of("normals are not finite and are ignored", bad_normals_);
    warn_of("colours are not finite and read as white", bad_colors_);
    for (const std::string& keyword : losses_) scene.losses.push_back("'" + keyword + "' statements");
    if (content_.positions.empty()) throw InvalidInput(file_ + ": holds no vertices; is it an OBJ file?");
    check_indices();
    return std::move(content_);
  }

 private:
  using List = ObjBackwardIndex::List;

  /// @param line  of the block.
  [[noreturn]] void fail(std::size_t line, const std::string& reason) const {
    throw InvalidInput(fmt::format("{}: line {}: {}", file_, lines_ + line, reason));
  }

  void place(const ObjBackwardIndex& index, ObjCornerList& corners) const {
    const std::size_t before = index.list == List::position ? content_.positions.size()
                               : index.list == List::uv     ? content_.uv.size()
                                                            : content_.normals.size();
    const auto length = static_cast<std::int64_t>(before + index.of_block);
    if (length + index.said < 0) fail(index.line, fmt::format("{} {} does not exist", name_of(index.list), index.said));
    if (index.corner == k_no_corner) return;
    Index& number = index.list == List::position ? corners.position(index.corner)
                    : index.list == List::uv     ? corners.uv(index.corner)
                                                 : corners.normal(index.corner);
    number = static_cast<Index>(length + index.said);
  }

  void append_faces(const ObjBlock& block) {
    const auto numbers = [](const ObjNames& names, ObjNames& all) {
      std::vector<std::uint32_t> result;
      for (const std::string& name : names.names()) result.push_back(all.number(name));
      return result;
    };
    const std::vector<std::uint32_t> objects = numbers(block.content.objects, content_.objects);
    const std::vector<std::uint32_t> groups = numbers(block.content.groups, content_.groups);
    const std::vector<std::uint32_t> materials = numbers(block.content.materials, content_.materials);
    const auto owner = [&](const ObjOwner& said) {
      return ObjOwner{said.object == k_as_before ? now_.object : objects[said.object],
                      said.group == k_as_before ? now_.group : groups[said.group],
                      said.material == k_as_before ? now_.material : materials[said.material]};
    };
    const std::size_t corners_before = content_.corners.size();
    for (const ObjRun& run : block.content.faces.runs()) {
      const ObjOwner its = owner(run.owner);
      block.content.faces.each(run, [&](const ObjFace& face) {
        const auto line = static_cast<std::uint32_t>(lines_ + face.line);
        content_.faces.push_back({corners_before + face.first_corner, face.corners, line}, its);
      });
    }
    now_ = owner(block.last);
  }

  void append_elements(const ObjContent& block) {
    if (!block.colors.empty()) {
      content_.colors.resize(content_.positions.size());
      append(content_.colors, block.colors);
    }
    append(content_.positions, block.positions);
    append(content_.uv, block.uv);
    append(content_.normals, block.normals);
    content_.corners.append(block.corners);
  }

  template <class T>
  void append(std::vector<T>& list, const std::vector<T>& more) const {
    if (more.size() > k_max_obj_elements - list.size()) fail(1, "more than 2^32 - 2 elements from here on");
    list.insert(list.end(), more.begin(), more.end());
  }

  void add(ObjOddity& all, const ObjOddity& more) const {
    if (all.count == 0 && more.count > 0) all.line = lines_ + more.line;
    all.count += more.count;
  }

  void check_indices() const {
    if (content_.corners.are_within(content_.positions.size(), content_.uv.size(), content_.normals.size())) return;
    const auto check = [&](const ObjFace& face, Index index, std::size_t size, List list) {
      if (index != k_no_index && index >= size)
        throw InvalidInput(fmt::format("{}: line {}: {} {} of {} does not exist", file_, face.line, name_of(list),
                                       std::size_t{index} + 1, size));
    };
    for (const ObjRun& run : content_.faces.runs())
      content_.faces.each(run, [&](const ObjFace& face) {
        for (std::size_t i = face.first_corner; i < face.first_corner + face.corners; ++i) {
          const ObjCorner corner = content_.corners[i];
          check(face, corner.position, content_.positions.size(), List::position);
          check(face, corner.uv, content_.uv.size(), List::uv);
          check(face, corner.normal, content_.normals.size(), List::normal);
        }
      });
  }

  const std::string& file_;
  ObjContent content_;
  std::size_t lines_ = 0;
  ObjOwner now_;
  ObjOddity short_faces_, bad_normals_, bad_colors_;
  std::set<std::string> losses_;
};

}  // namespace

ObjContent read_obj_content(std::string_view text, const std::string& file, Scene& scene) {
  using oneapi::tbb::filter_mode;
  using oneapi::tbb::make_filter;
  ObjAssembly assembly(file);
  assembly.make_room(text);
  std::string_view rest = text;
  const auto cut = [&](oneapi::tbb::flow_control& control) {
    if (rest.empty()) control.stop();
    return cut_block(rest);
  };
  const auto parse = [](std::string_view block) { return std::make_shared<ObjBlock>(parse_obj_block(block)); };
  const auto append = [&](const std::shared_ptr<ObjBlock>& block) { assembly.append(std::move(*block)); };
  const auto at_once = static_cast<std::size_t>(oneapi::tbb::this_task_arena::max_concurrency()) + 2;
  oneapi::tbb::parallel_pipeline(
      at_once, make_filter<void, std::string_view>(filter_mode::serial_in_order, cut) &
                   make_filter<std::string_view, std::shared_ptr<ObjBlock>>(filter_mode::parallel, parse) &
                   make_filter<std::shared_ptr<ObjBlock>, void>(filter_mode::serial_in_order, append));
  return assembly.finish(scene);
}

}  // namespace papilla::io_detail
