# SPDX-License-Identifier: MIT
# Makes triangles of an OBJ file loose, each corner moved by a hair: cracks from 1e-5 to 1 mm, as many of every size.
BEGIN { srand(1) }
function moved(x) { return x + (rand() - 0.5) * 10 ^ (-5 * width) }
$1 == "v" { ++vertices; x[vertices] = $2; y[vertices] = $3; z[vertices] = $4 }
$1 == "f" {
  for (k = 2; k <= 4; ++k) { width = rand(); printf "v %.7f %.7f %.7f\n", moved(x[$k]), moved(y[$k]), moved(z[$k]) }
  ++triangles
}
END { for (t = 0; t < triangles; ++t) printf "f %d %d %d\n", 3 * t + 1, 3 * t + 2, 3 * t + 3 }
