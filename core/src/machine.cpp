// SPDX-License-Identifier: MIT
#include "papilla/core/machine.hpp"

#include <sys/utsname.h>
#include <unistd.h>

#include <charconv>
#include <fstream>
#include <string_view>

namespace papilla {
namespace {

/// The value after "key<blanks>:" in a file of /proc, or "".
std::string proc_value(const char* file, std::string_view key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t colon = line.find(':');
    const std::size_t begin = colon == std::string::npos ? colon : line.find_first_not_of(" \t", colon + 1);
    return begin == std::string::npos ? "" : line.substr(begin);
  }
  return "";
}

std::int64_t kb_of(const std::string& text) {
  std::int64_t kb = 0;
  std::from_chars(text.data(), text.data() + text.size(), kb);
  return kb;
}

}  // namespace

Machine this_machine() {
  utsname system{};
  ::uname(&system);
  return {proc_value("/proc/cpuinfo", "model name"), static_cast<int>(::sysconf(_SC_NPROCESSORS_ONLN)),
          kb_of(proc_value("/proc/meminfo", "MemTotal")) / 1024, std::string(system.sysname) + " " + system.release};
}

double peak_rss_mib() { return static_cast<double>(kb_of(proc_value("/proc/self/status", "VmHWM"))) / 1024; }

}  // namespace papilla
