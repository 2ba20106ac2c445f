# SPDX-License-Identifier: MIT
# A sheet of 200 x 160 mm with a bulge and a wave, like the skin of a dashboard, as OBJ: what every map is shown on.
BEGIN {
  n = 60; pi = 3.14159265358979
  for (j = 0; j <= n; ++j)
    for (i = 0; i <= n; ++i)
      printf "v %.6f %.6f %.6f\n", 200 * i / n, 160 * j / n, 60 * sin(pi * i / n) * sin(pi * j / n) + 12 * sin(3 * pi * i / n)
  for (j = 0; j < n; ++j)
    for (i = 0; i < n; ++i) {
      a = j * (n + 1) + i + 1
      printf "f %d %d %d\nf %d %d %d\n", a, a + 1, a + n + 2, a, a + n + 2, a + n + 1
    }
}
