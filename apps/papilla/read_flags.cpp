// SPDX-License-Identifier: GPL-3.0-or-later
#include "read_flags.hpp"

#include <string>

namespace papilla::app {

void add_read_flags(CLI::App& verb, ReadOptions& options) {
  verb.add_option_function<std::string>(
          "--unit",
          [&options](const std::string& unit) {
            options.millimetres_per_unit = unit == "mm"   ? 1
                                           : unit == "cm" ? 10
                                           : unit == "m"  ? 1000
                                           : unit == "in" ? 25.4
                                                          : 304.8;
          },
          "Unit of a file that states none")
      ->check(CLI::IsMember({"mm", "cm", "m", "in", "ft"}))
      ->default_str("mm");
  verb.add_option_function<std::string>(
          "--up",
          [&options](const std::string& up) {
            if (up != "file") options.up = up == "y" ? UpAxis::y : UpAxis::z;
          },
          "Axis that points up; file: as the format has it")
      ->check(CLI::IsMember({"y", "z", "file"}))
      ->default_str("file");
}

}  // namespace papilla::app
