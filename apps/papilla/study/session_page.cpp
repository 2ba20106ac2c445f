// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <string>

#include "html_text.hpp"
#include "json/embedded_json.hpp"
#include "papilla/core/error.hpp"
#include "study/page_session.hpp"

namespace papilla::app {
namespace {

constexpr const char* k_style = R"css(
:root{color-scheme:light dark;--back:#f6f7f9;--card:#fff;--ink:#16191d;--soft:#59616b;--line:#cfd5dc;--accent:#0a5fb4}
@media(prefers-color-scheme:dark){:root{--back:#14171b;--card:#1d2228;--ink:#e8ebef;--soft:#a3adb8;--line:#3a424c;--accent:#7cb8ff}}
*{box-sizing:border-box}[hidden]{display:none!important}
body{margin:0;background:var(--back);color:var(--ink);font:17px/1.5 system-ui,sans-serif}
main{max-width:52rem;margin:0 auto;padding:1.5rem}
h1{font-size:1.1rem;margin:0;color:var(--soft);font-weight:normal}h2{font-size:1.35rem;margin:.6rem 0}
section{background:var(--card);border:1px solid var(--line);border-radius:10px;padding:1.2rem;margin-top:1rem}
fieldset{border:0;margin:.6rem 0 0;padding:0}legend{font-size:1.35rem;padding:0}
#answers{display:flex;flex-wrap:wrap;gap:.5rem;margin-top:.6rem}
label{display:flex;gap:.45rem;align-items:center;border:1px solid var(--line);border-radius:8px;padding:.5rem .8rem;cursor:pointer}
label:has(:checked){border-color:var(--accent);box-shadow:0 0 0 1px var(--accent)}
button{font:inherit;padding:.5rem 1.1rem;border-radius:8px;border:1px solid var(--line);background:var(--back);color:var(--ink);cursor:pointer}
button.main{background:var(--accent);border-color:var(--accent);color:var(--card)}button:disabled{opacity:.45;cursor:default}
:focus-visible{outline:3px solid var(--accent);outline-offset:2px}
.row{display:flex;flex-wrap:wrap;gap:.6rem;align-items:center;margin-top:.8rem}
#pictures{display:grid;grid-template-columns:repeat(auto-fit,minmax(8rem,1fr));gap:.6rem;max-width:46rem}
figure{margin:0}figure img{width:100%;max-width:16rem;border-radius:6px}figcaption,.soft{color:var(--soft);font-size:.9rem}
code{font-size:.85rem;overflow-wrap:anywhere}progress{width:100%}#status{min-height:1.5em;color:var(--soft)}
)css";

constexpr const char* k_script = R"js(
'use strict';
const D = JSON.parse(document.getElementById('data').textContent);
const $ = id => document.getElementById(id), W = D.words;
const at = path => path + location.search;
let place = D.place, begun = 0, shown = 0, typed = '', typedAt = 0, since = 0, busy = false, polling = 0;

const trial = () => D.trials[place - 1], block = () => D.blocks[trial().block];
const experiment = () => D.experiments[block().experiment];

async function ask(path, body) {
  const reply = await fetch(at(path), body === undefined ? {} : {method: 'POST', body: JSON.stringify(body)});
  let said = {};
  try { said = await reply.json(); } catch { /* A refusal without text. */ }
  if (!reply.ok) throw new Error(said.error || W.lost);
  return said;
}
const tell = text => { $('status').textContent = text; };

function make(tag, text, parent, set = {}) {
  const element = Object.assign(document.createElement(tag), set);
  if (text) element.textContent = text;
  parent.append(element);
  return element;
}

/// Buttons that play plates, or the commands that do.
function plates(parent, files, names) {
  parent.replaceChildren();
  files.forEach((file, i) => {
    const row = make('div', '', parent, {className: 'row'});
    if (D.plays) {
      make('button', names[i], row, {type: 'button', className: 'play', onclick: () => play(file, names[i])});
    } else {
      make('span', names[i] + ':', row);
      make('code', D.commands[file], row);
    }
  });
}

async function play(file, name) {
  try {
    await ask('play', {file});
    tell(name + ' ' + W.playing);
    clearInterval(polling);
    polling = setInterval(watch, 250);
  } catch (error) { tell(error.message); }
}
async function watch() {
  try {
    const state = await ask('state');
    if (state.playing) return;
    clearInterval(polling);
    tell(state.failure || W.gone);
  } catch (error) { clearInterval(polling); tell(error.message); }
}

function show() {
  $('progress').max = D.trials.length;
  $('progress').value = Math.min(place - 1, D.trials.length);
  const done = place > D.trials.length;
  $('done').hidden = !done;
  $('intro').hidden = $('trial').hidden = true;
  if (done) { $('count').textContent = ''; $('done').focus(); return; }
  $('count').textContent = W.trial + ' ' + place + ' / ' + D.trials.length;
  if (begun !== trial().block + 1) return show_intro();
  show_trial();
}

function show_intro() {
  $('intro').hidden = false;
  $('instructions').textContent = experiment().instructions;
  plates($('shown'), block().shown, block().shown.map((_, i) => W.plate + ' ' + (i + 1)));
  $('begin').focus();
}

function show_trial() {
  const e = experiment(), t = trial();
  $('trial').hidden = false;
  $('pictures').replaceChildren();
  for (const picture of t.pictures) {
    const figure = make('figure', '', $('pictures'));
    make('img', '', figure, {src: at(picture.file), alt: picture.name});
    if (e.kind === 'identification') make('figcaption', picture.name, figure);
  }
  plates($('plates'), t.files, t.files.length > 1 ? e.labels : [W.plate]);
  $('question').textContent = e.question;
  $('answers').replaceChildren();
  e.answers.forEach((answer, i) => {
    const label = make('label', '', $('answers'));
    make('input', '', label, {type: 'radio', name: 'answer', value: answer.value, onchange: ready});
    make('span', answer.name, label);
  });
  $('next').disabled = true;
  $('back').disabled = place < 2;
  typed = '';
  since = performance.now();
  ($('plates').querySelector('button') || $('answers').querySelector('input')).focus();
}

const chosen = () => $('answers').querySelector('input:checked');
function ready() { $('next').disabled = !chosen(); }

async function next() {
  if (!chosen() || busy) return;
  busy = true;
  try {
    const state = await ask('answer', {place, answer: chosen().value, seconds: (performance.now() - since) / 1000});
    place = state.place;
    tell('');
    show();
  } catch (error) { tell(error.message); }
  busy = false;
}

/// A number of two digits may be typed within a second.
function type_digit(digit) {
  const now = performance.now(), values = experiment().answers.map((answer, i) => answer.key);
  typed = now - typedAt < 1000 ? typed + digit : digit;
  typedAt = now;
  let i = values.indexOf(Number(typed));
  if (i < 0) { typed = digit; i = values.indexOf(Number(typed)); }
  if (i < 0) return;
  const input = $('answers').querySelectorAll('input')[i];
  input.checked = true;
  input.focus();
  ready();
}

$('begin').onclick = () => { begun = trial().block + 1; tell(''); show(); };
$('next').onclick = next;
$('back').onclick = () => { if (place > 1) { place -= 1; begun = trial().block + 1; show(); } };
$('stop').onclick = async () => { try { await ask('stop', {}); } catch (error) { tell(error.message); } };
document.addEventListener('keydown', event => {
  if ($('trial').hidden || event.ctrlKey || event.metaKey || event.altKey) return;
  if (/^[0-9]$/.test(event.key)) { type_digit(event.key); event.preventDefault(); }
  if (event.key === 'Enter' && event.target.tagName !== 'BUTTON') { next(); event.preventDefault(); }
  const plays = $('plates').querySelectorAll('button');
  const which = 'ab'.indexOf(event.key.toLowerCase());
  if (which >= 0 && plays[which]) { plays[which].click(); event.preventDefault(); }
});
show();
)js";

Json words_of(const std::string& language) {
  if (language == "de")
    return {{"trial", "Frage"},
            {"plate", "Platte"},
            {"playing", "liegt jetzt auf dem Gerät"},
            {"gone", "Die Platte ist weg."},
            {"lost", "Das Programm antwortet nicht. Was beantwortet ist, ist gespeichert."},
            {"begin", "Beginnen"},
            {"next", "Weiter"},
            {"back", "Zurück"},
            {"stop", "Gerät anhalten"},
            {"done", "Alle Fragen sind beantwortet. Vielen Dank."},
            {"keys", "Tasten: A und B spielen die Platten, Ziffern wählen, Eingabe geht weiter."}};
  return {{"trial", "Trial"},
          {"plate", "Plate"},
          {"playing", "is on the device now"},
          {"gone", "The plate is gone."},
          {"lost", "The program does not answer. What was answered is saved."},
          {"begin", "Begin"},
          {"next", "Next"},
          {"back", "Back"},
          {"stop", "Stop the device"},
          {"done", "All trials are answered. Thank you."},
          {"keys", "Keys: A and B play the plates, digits choose, Enter goes on."}};
}

/// What may be answered, its name, and the number that is typed for it.
Json answers_of(const StudyExperiment& e) {
  Json answers = Json::array();
  if (e.kind != StudyAnswerKind::rating) {
    for (std::size_t i = 0; i < e.labels.size(); ++i)
      answers.push_back({{"value", e.kind == StudyAnswerKind::identification ? e.labels[i]
                                   : i == 0                                  ? "first"
                                                                             : "second"},
                         {"name", fmt::format("{} {}", i + 1, e.labels[i])},
                         {"key", i + 1}});
    return answers;
  }
  const bool names_all = e.labels.size() == static_cast<std::size_t>(e.high - e.low + 1);
  for (int step = e.low; step <= e.high; ++step) {
    std::string name = std::to_string(step);
    if (names_all) name += " " + e.labels[static_cast<std::size_t>(step - e.low)];
    if (!names_all && step == e.low) name += " " + e.labels.front();
    if (!names_all && step == e.high) name += " " + e.labels.back();
    answers.push_back({{"value", std::to_string(step)}, {"name", name}, {"key", step}});
  }
  return answers;
}

Json data_of(const StudySession& session, const StimulusPlayer& player) {
  const Study& study = session.study();
  Json data{{"place", session.next()},      {"plays", player.plays()}, {"words", words_of(study.language)},
            {"experiments", Json::array()}, {"blocks", Json::array()}, {"trials", Json::array()},
            {"commands", Json::object()}};
  for (const StudyExperiment& e : study.experiments)
    data["experiments"].push_back({{"kind", to_string(e.kind)},
                                   {"instructions", e.instructions},
                                   {"question", e.question},
                                   {"labels", e.labels},
                                   {"answers", answers_of(e)}});
  const auto file_of = [&](std::size_t stimulus) {
    const std::string& file = study.stimuli[stimulus].file;
    if (!player.plays()) data["commands"][file] = player.command(session.file(file));
    return file;
  };
  std::size_t number = 0;
  for (const StudyBlock& block : study.participants[session.participant() - 1]) {
    Json shown = Json::array();
    for (const std::size_t stimulus : block.shown) shown.push_back(file_of(stimulus));
    data["blocks"].push_back({{"experiment", study.trials[block.trials.front()].experiment}, {"shown", shown}});
    for (const std::size_t index : block.trials) {
      const StudyTrial& trial = study.trials[index];
      Json one{{"block", number}, {"files", Json::array()}, {"pictures", Json::array()}};
      for (const std::size_t stimulus : trial.stimuli) one["files"].push_back(file_of(stimulus));
      for (const std::string& picture : trial.pictures)
        one["pictures"].push_back({{"file", picture}, {"name", std::filesystem::path(picture).stem().string()}});
      data["trials"].push_back(std::move(one));
    }
    ++number;
  }
  return data;
}

}  // namespace

std::string session_page(const StudySession& session, const StimulusPlayer& player) {
  const std::string& language = session.study().language;
  const Json words = words_of(language);
  const auto word = [&](const char* key) { return html_text(words.at(key).get<std::string>()); };
  return fmt::format(
      "<!doctype html><html lang=\"{}\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">"
      "<title>{} {}</title><style>{}</style>\n<main><h1 id=\"count\"></h1><progress id=\"progress\" value=\"0\" "
      "max=\"1\"></progress>\n<section id=\"intro\" hidden><p id=\"instructions\"></p><div id=\"shown\"></div><div "
      "class=\"row\"><button id=\"begin\" class=\"main\" type=\"button\">{}</button></div></section>\n<section "
      "id=\"trial\" hidden><div id=\"pictures\"></div><div id=\"plates\"></div><fieldset><legend "
      "id=\"question\"></legend><div id=\"answers\"></div></fieldset><div class=\"row\"><button id=\"back\" "
      "type=\"button\">{}</button><button id=\"next\" class=\"main\" type=\"button\">{}</button>{}</div><p "
      "class=\"soft\">{}</p></section>\n<section id=\"done\" tabindex=\"-1\" hidden><h2>{}</h2></section>\n<p "
      "id=\"status\" role=\"status\" aria-live=\"polite\"></p><footer class=\"soft\">papilla {}</footer></main>\n"
      "<script type=\"application/json\" id=\"data\">{}</script>\n<script>{}</script></html>\n",
      language, word("plate"), session.participant(), k_style, word("begin"), word("back"), word("next"),
      player.plays() ? "<button id=\"stop\" type=\"button\">" + word("stop") + "</button>"
                     : std::string("<button id=\"stop\" type=\"button\" hidden></button>"),
      word("keys"), word("done"), version(), embedded_json(data_of(session, player)), k_script);
}

}  // namespace papilla::app
