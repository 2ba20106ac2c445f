// SPDX-License-Identifier: MIT
#include "papilla/core/file_guard.hpp"

#include <algorithm>
#include <mutex>
#include <system_error>
#include <vector>

namespace papilla {
namespace {

namespace fs = std::filesystem;

struct Entry {
  fs::path file;           ///< With links resolved as far as it exists.
  std::string name, path;  ///< For messages.
  bool written = false;
};

struct Guard {
  std::mutex mutex;
  bool active = false;
  std::vector<Entry> inputs, outputs;
};

Guard& guard() {
  static Guard the_guard;
  return the_guard;
}

/// The path with links resolved as far as it exists; empty for what is no file and can't become one by its name.
fs::path resolved(const fs::path& path) {
  std::error_code error;
  const fs::path file = fs::weakly_canonical(fs::absolute(path, error), error);
  if (error) return {};
  const fs::file_status status = fs::status(file, error);
  return fs::exists(status) && !fs::is_regular_file(status) ? fs::path() : file;
}

Entry* find(std::vector<Entry>& entries, const fs::path& file) {
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) {
    std::error_code missing;
    return entry.file == file || fs::equivalent(entry.file, file, missing);
  });
  return found == entries.end() ? nullptr : &*found;
}

std::string named(const Entry& entry) { return entry.name.empty() ? entry.path : entry.name + " " + entry.path; }

void add_input(const fs::path& path, const std::string& name) {
  Guard& all = guard();
  const std::scoped_lock lock(all.mutex);
  const fs::path file = all.active ? resolved(path) : fs::path();
  if (file.empty()) return;
  const Entry* output = find(all.outputs, file);
  if (output && output->written) return;
  const auto is_known = [&](const Entry& entry) { return entry.file == file; };
  if (std::none_of(all.inputs.begin(), all.inputs.end(), is_known)) all.inputs.push_back({file, name, path.string()});
  if (output) throw OverwriteRefused(named(*output) + ": would be written over what is read");
}

/// @param declared  whether the file is written later.
void add_output(const fs::path& path, const std::string& name, bool declared) {
  Guard& all = guard();
  const std::scoped_lock lock(all.mutex);
  const fs::path file = all.active ? resolved(path) : fs::path();
  if (file.empty()) return;
  const Entry entry{file, name, path.string()};
  if (const Entry* input = find(all.inputs, file))
    throw OverwriteRefused(named(entry) + ": would be written over " + named(*input) + ", which is read");
  Entry* known = find(all.outputs, file);
  if (known && (declared || known->written))
    throw OverwriteRefused(named(entry) + ": is the same file as " + named(*known) + ", which is written too");
  if (!known) known = &all.outputs.emplace_back(entry);
  known->written = !declared;
}

}  // namespace

void start_file_guard() {
  const std::scoped_lock lock(guard().mutex);
  guard().active = true;
}

void declare_input(const fs::path& path, const std::string& name) { add_input(path, name); }

void declare_output(const fs::path& path, const std::string& name) { add_output(path, name, true); }

void note_input(const fs::path& path) { add_input(path, ""); }

void note_output(const fs::path& path) { add_output(path, "", false); }

void forget_written_outputs() {
  const std::scoped_lock lock(guard().mutex);
  for (Entry& output : guard().outputs) output.written = false;
}

void end_file_guard() {
  const std::scoped_lock lock(guard().mutex);
  guard().active = false;
}

}  // namespace papilla
