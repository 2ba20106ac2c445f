// SPDX-License-Identifier: GPL-3.0-or-later
#include "gwyddion_dimension.hpp"

#include <libprocess/fractals.h>
#include <libprocess/gwyprocess.h>

#include <algorithm>

namespace papilla::bench {

double gwyddion_partitioning_dimension(const GreyImage& image) {
  static const bool initialised = (gwy_process_type_init(), true);
  static_cast<void>(initialised);
  GwyDataField* field = gwy_data_field_new(image.width, image.height, image.width, image.height, FALSE);
  std::copy(image.pixels.begin(), image.pixels.end(), gwy_data_field_get_data(field));
  GwyDataLine* x = gwy_data_line_new(1, 1.0, TRUE);
  GwyDataLine* y = gwy_data_line_new(1, 1.0, TRUE);
  gwy_data_field_fractal_partitioning(field, x, y, GWY_INTERPOLATION_LINEAR);
  double a = 0, b = 0;
  const double dimension = gwy_data_field_fractal_partitioning_dim(x, y, &a, &b);
  g_object_unref(field);
  g_object_unref(x);
  g_object_unref(y);
  return dimension;
}

}  // namespace papilla::bench
