// SPDX-License-Identifier: GPL-3.0-or-later
#include "weather/weather_page.hpp"

#include <fmt/core.h>

#include "html_text.hpp"
#include "papilla/core/base64.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/pictures/scene_render.hpp"

namespace papilla::app {
namespace {

constexpr const char* k_style =
    "body{font:15px/1.5 system-ui,sans-serif;margin:2em auto;max-width:75em;padding:0 1em}figure{margin:0}"
    ".pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(20em,1fr));gap:1em}img{width:100%;height:auto}"
    "td,th{padding:2px 8px;text-align:left;vertical-align:top;border-bottom:1px solid #ccc}"
    "code,pre{font-size:12px;white-space:pre-wrap;overflow-wrap:anywhere}input{width:100%}";

/// Shows the picture of the slider's step; the step is kept in the address.
constexpr const char* k_script =
    "const "
    "s=document.getElementById('time'),n=document.getElementById('now'),f=[...document.querySelectorAll('.step')];"
    "function show(){f.forEach((e,i)=>e.hidden=i!=s.value);n.textContent=f[s.value].dataset.time;"
    "history.replaceState(null,'','#'+s.value)}"
    "const h=parseInt(location.hash.slice(1));if(h>=0&&h<f.length)s.value=h;s.addEventListener('input',show);show()";

std::string image(const ColorImage& picture, const std::string& alt) {
  return fmt::format("<img alt=\"{}\" width=\"{}\" height=\"{}\" src=\"data:image/png;base64,{}\">", alt, picture.width,
                     picture.height, encode_base64(encode_png(picture)));
}

std::string row(const WeatheredMaterial& material) {
  const std::string text = fmt::format("<tr><td>{}", html_text(material.name));
  if (!material.skipped.empty()) return text + "<td colspan=4>" + html_text(material.skipped);
  if (!material.painted()) return text + "<td colspan=4>no layer fits";
  std::string uses, maps = "one repeat";
  for (const std::string& name : material.uses) uses += (uses.empty() ? "" : ", ") + name;
  if (const auto& atlas = material.atlas)
    maps =
        fmt::format("atlas of {} x {}: {} charts, {} unlike", atlas->width, atlas->height, atlas->charts, atlas->tiles);
  return text +
         fmt::format("<td>{}<td>{}<td>{:.3f}<td>{:.2f}", html_text(uses), maps, material.friction, material.stiffness);
}

}  // namespace

ColorImage view_of(const Scene& scene) {
  SceneViewOptions options;
  options.width = 800, options.height = 600;
  return render_scene(scene, options);
}

std::string weather_page(const std::string& title, const ColorImage& before, const std::vector<WeatherView>& after,
                         const std::vector<WeatheredMaterial>& materials, const std::string& config, bool live) {
  std::string page = fmt::format(
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\">{}<title>{}</title><style>{}</style>\n<h1>{}</h1>\n<div class=\"pair\">"
      "<figure>{}<figcaption>before</figcaption></figure>\n<div>",
      live ? "<meta http-equiv=\"refresh\" content=\"2\">" : "", html_text(title), k_style, html_text(title),
      image(before, "the scene before"));
  for (const WeatherView& view : after)
    page += fmt::format("<figure class=\"step\" data-time=\"{:.2f}\">{}<figcaption>after</figcaption></figure>\n",
                        view.time, image(view.picture, fmt::format("the scene at time {:.2f}", view.time)));
  page += fmt::format(
      "</div></div>\n<p><label>Time <output id=\"now\"></output> (0 new, 1 worn)<input id=\"time\" type=\"range\" "
      "min=\"0\" max=\"{}\" value=\"{}\"></label></p>\n<h2>Materials</h2>\n<table><tr><th>material<th>recipes<th>maps"
      "<th>friction<th>stiffness</tr>\n",
      after.size() - 1, after.size() - 1);
  for (const WeatheredMaterial& material : materials) page += row(material) + "</tr>\n";
  return page + fmt::format(
                    "</table>\n<p>Friction and stiffness are means over the surface, at the last time.</p>\n"
                    "<h2>Configuration</h2>\n<pre>{}</pre>\n<script>{}</script>\n</html>\n",
                    html_text(config), k_script);
}

}  // namespace papilla::app
