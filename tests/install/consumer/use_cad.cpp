// SPDX-License-Identifier: MIT
#include <papilla/core/error.hpp>
#include <papilla/io/cad_reader.hpp>

int main() {
  try {
    papilla::read_cad("missing.step");
  } catch (const papilla::IoError&) {
    return papilla::is_cad_extension("cockpit.STP") ? 0 : 1;
  }
  return 1;
}
