// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/materials_page.hpp"

#include <fmt/format.h>

#include <map>

#include "html_text.hpp"
#include "papilla/core/error.hpp"
#include "papilla/pipeline/material_library.hpp"

namespace papilla::app {
namespace {

constexpr const char* k_style =
    ":root{color-scheme:light dark;--back:#f6f7f9;--card:#fff;--ink:#16191d;--soft:#59616b;--line:#cfd5dc;--accent:"
    "#0a5fb4}@media(prefers-color-scheme:dark){:root{--back:#14171b;--card:#1d2228;--ink:#e8ebef;--soft:#a3adb8;--line:"
    "#3a424c;--accent:#7cb8ff}}*{box-sizing:border-box}[hidden]{display:none!important}body{margin:0;background:"
    "var(--back);color:var(--ink);font:15px/1.45 system-ui,sans-serif}h1{font-size:1.4rem;margin:0}h2{font-size:1rem;"
    "margin:.5rem 0 0}header{display:flex;flex-wrap:wrap;gap:.6rem 1.2rem;align-items:center;padding:.8rem 1.2rem;"
    "position:sticky;top:0;background:var(--back);border-bottom:1px solid var(--line)}input,select{font:inherit}input{"
    "min-width:18rem}:focus-visible{outline:3px solid var(--accent);outline-offset:2px}main{display:grid;"
    "grid-template-columns:repeat(auto-fill,minmax(20rem,1fr));gap:1rem;padding:1rem 1.2rem}article{background:"
    "var(--card);border:1px solid var(--line);border-radius:8px;padding:.8rem;overflow-wrap:anywhere}img{width:100%;"
    "height:auto;border-radius:4px}p{margin:.2rem 0}.soft,summary{color:var(--soft);font-size:.9rem}table{"
    "border-collapse:collapse;font-size:.85rem;font-variant-numeric:tabular-nums}td{padding:.1rem .5rem .1rem 0;"
    "vertical-align:top;border-bottom:1px solid var(--line)}";

/// A card is shown when it has every word that is sought, folded as the cards' words are, and is of the category.
constexpr const char* k_script =
    "const find=document.getElementById('find'),kind=document.getElementById('kind'),count=document.getElementById("
    "'count'),cards=[...document.querySelectorAll('article')];"
    "const fold=t=>t.toLowerCase().replace(/ß/g,'ss').normalize('NFD').replace(/[\\u0300-\\u036f]/g,'').replace("
    "/[^a-z0-9\\u0080-\\uffff]/g,' ').replace(/([aou])e/g,'$1');"
    "function show(){const words=fold(find.value).split(' ').filter(w=>w);let n=0;for(const card of cards){"
    "card.hidden=!words.every(w=>card.dataset.words.includes(w))||(kind.value&&card.dataset.kind!==kind.value);"
    "n+=!card.hidden}count.textContent=n+' / '+cards.length;history.replaceState(null,'',find.value?'#'+"
    "encodeURIComponent(find.value):location.pathname)}"
    "try{find.value=decodeURIComponent(location.hash.slice(1))}catch{}"
    "find.addEventListener('input',show);kind.addEventListener('input',show);show()";

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

std::string all_words(const LibraryMaterial& m) {
  std::string words = m.id + " " + m.name_en + " " + m.name_de;
  for (const BilingualWords* of : {&m.aliases, &m.categories, &m.uses})
    for (const auto* list : {&of->en, &of->de})
      for (const std::string& word : *list) words += " " + word;
  return folded(words);
}

std::string card(const MaterialsPageEntry& entry) {
  const LibraryMaterial& m = *entry.material;
  std::string out = fmt::format(
      "<article data-words=\"{}\" data-kind=\"{}\"><img loading=\"lazy\" alt=\"{}: lit ball and relief\" "
      "src=\"{}\"><h2>{}</h2><p lang=\"de\">{}</p><p><code>library:{}</code></p>",
      html_text(all_words(m)), html_text(m.categories.en.front()), html_text(m.name_en), html_text(entry.picture),
      html_text(m.name_en), html_text(m.name_de), html_text(m.id));
  for (const BilingualWords* words : {&m.aliases, &m.uses})
    if (!words->en.empty() || !words->de.empty())
      out += fmt::format("<p class=\"soft\">{} <span lang=\"de\">· {}</span></p>", html_text(joined(words->en)),
                         html_text(joined(words->de)));
  std::size_t cited = 0;
  std::string rows;
  const std::vector<LibraryNumber> numbers = numbers_of(m);
  for (const LibraryNumber& number : numbers) {
    if (!number.source.empty()) ++cited;
    rows += fmt::format("<tr><td>{}<td>{}<td>{}{}{}</tr>", html_text(number.key), html_text(number.value),
                        number.source.empty() ? "estimated" : html_text(m.sources.at(number.source)),
                        number.note.empty() ? "" : " – ", html_text(number.note));
  }
  return out + fmt::format(
                   "<p>{} N/m, friction {} / {}</p><details><summary>{} numbers, {} cited</summary><table>{}</table>"
                   "</details></article>\n",
                   m.stiffness.value, m.static_friction.value, m.dynamic_friction.value, numbers.size(), cited, rows);
}

}  // namespace

std::string materials_page(const std::vector<MaterialsPageEntry>& entries) {
  std::map<std::string, std::string> kinds;
  for (const MaterialsPageEntry& entry : entries)
    kinds.emplace(entry.material->categories.en.front(), entry.material->categories.de.front());
  std::string page = fmt::format(
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src 'self' data: file:; "
      "style-src "
      "'unsafe-inline'; script-src 'unsafe-inline'\"><title>Material library</title><style>{}</style>\n<header>"
      "<h1>Material library</h1><label>Search · Suche <input id=\"find\" type=\"search\" autocomplete=\"off\"></label>"
      "<label>Category · Kategorie <select id=\"kind\"><option value=\"\">all · alle</option>",
      k_style);
  for (const auto& [en, de] : kinds)
    page += fmt::format("<option value=\"{}\">{} · {}</option>", html_text(en), html_text(en), html_text(de));
  page += "</select></label><output id=\"count\"></output></header>\n<main>\n";
  for (const MaterialsPageEntry& entry : entries) page += card(entry);
  return page + fmt::format("</main><footer class=\"soft\">papilla {}</footer>\n<script>{}</script>\n</html>\n",
                            version(), k_script);
}

}  // namespace papilla::app
