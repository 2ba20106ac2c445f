// SPDX-License-Identifier: MIT
// Presses the wrapper for Unreal 2 mm into a plate in the plane y = 0 of a file: usage: unreal_test LIBRARY PLATE.glb
#include <cmath>
#include <cstdio>

#include "../../examples/unreal/PapillaHaptic.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  FPapillaLibrary missing, library;
  if (missing.Load(FString(u"libmissing.so")) || !library.Load(FString(UTF8_TO_TCHAR(argv[1])))) return 1;
  FPapillaScene scene(library);
  FString reason;
  if (scene.Open(FString(u"missing.glb"), 1000, 3.3, reason)) return 1;
  if (to_utf8(*reason).find("missing.glb") == std::string::npos) return 1;
  if (!scene.Open(FString(UTF8_TO_TCHAR(argv[2])), 1000, 3.3, reason)) {
    std::fprintf(stderr, "%s\n", to_utf8(*reason).c_str());
    return 1;
  }
  // Up is Z, in centimetres; the plate is at z = 0 and its y is the file's z.
  FVector force, drawn;
  scene.Reset(FVector(5, -5, 0.5));
  for (int i = 0; i < 800; ++i)  // Twice: the first force fades in.
    if (scene.Tick(FVector(5, -5, std::fmax(0.5 - 0.002 * (i % 400), -0.2)), 0, force) < 0) return 1;
  const int32 material = scene.Proxy(drawn);
  std::printf("%.4f %.4f %.4f N, drawn at %.4f %.4f %.4f cm\n", force.X, force.Y, force.Z, drawn.X, drawn.Y, drawn.Z);
  // 300 N/m, a ball of 0.5 mm whose surface is 2.5 mm deep.
  return material == 0 && std::abs(force.Z - 300 * 2.5e-3) < 1e-3 && std::abs(force.X) + std::abs(force.Y) < 1e-9 &&
                 std::abs(drawn.Z - 0.052) < 1e-3 && std::abs(drawn.Y + 5) < 1e-9
             ? 0
             : 1;
}
