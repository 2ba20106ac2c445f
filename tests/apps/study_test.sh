#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A study from its stimuli to its report: sessions in the terminal and on the page that are killed go on, and damaged
# answers are named. usage: study_test.sh PAPILLA FOLDER
set -u
papilla=$1
# shellcheck source=tests/apps/failures.sh
source "$(dirname "$0")/failures.sh" "$2"

"$papilla" study new -o made --experiments grains,dimension --models lateral --dimensions 2.2,2.5,2.8 --repetitions 1 \
  --participants 2 --json new.json -q || fail "study new: exit $?"
[[ $(find made/stimuli -name 's*.glb' | wc -l) == 15 && -s made/pictures/ovals8.png ]] || fail "stimuli: $(ls made/stimuli)"
grep -q '"trials"' new.json && grep -q '"factors"' new.json || fail "new.json: $(head -c 300 new.json)"
"$papilla" study new -o again --experiments grains,dimension --models lateral --dimensions 2.2,2.5,2.8 --repetitions 1 \
  --participants 2 -q || fail "study new: exit $?"
diff -r made again >/dev/null || fail "the same options give another study"

lines() { tail -n +2 made/answers/participant-001.csv | wc -l; }

# Ten grains, then four pairs: a wrong word, a number, a name, back, again, stop.
printf '\nbanana\n1\nquads8\nb\n2\nr\n3\nq\n' | "$papilla" study run made/STUDY.json --participant 1 -q 2>said.txt ||
  fail "study run: exit $?"
grep -q "'banana' is none of 1 to 6 and r, b, q" said.txt || fail "no reason: $(cat said.txt)"
[[ $(lines) == 4 ]] || fail "four answers, one of them a correction: $(cat made/answers/participant-001.csv)"

# A study whose answers are there is not written over, and a plate that cannot be played takes no answer.
"$papilla" study new -o made --experiments dimension -q 2>said.txt
[[ $? == 3 ]] && grep -q 'participant-001.csv: is of the study that is there' said.txt || fail "written over: $(cat said.txt)"
diff made/STUDY.json again/STUDY.json >/dev/null || fail "STUDY.json has changed"
rm again/stimuli/*.glb
printf '\n1\nq\n' | "$papilla" study run again/STUDY.json --participant 1 --device sim --play-seconds 0.1 -q 2>said.txt ||
  fail "study run: exit $?"
grep -q 'a plate was not there, so that no answer is taken' said.txt || fail "taken: $(cat said.txt)"
[[ $(wc -l <again/answers/participant-001.csv) -le 1 ]] || fail "taken: $(cat again/answers/participant-001.csv)"

# Killed between answers: what was answered is there, and the next one is asked.
mkfifo typed
"$papilla" study run made/STUDY.json --participant 1 -q <typed 2>killed.txt &
session=$!
exec 3>typed
printf '\n1\n1\n' >&3
until [[ $(lines) == 6 ]]; do kill -0 $session || break; done
kill -KILL $session
wait $session 2>/dev/null
exec 3>&-
[[ $(lines) == 6 ]] || fail "answers are lost: $(cat made/answers/participant-001.csv)"
printf 'cut off' >>made/answers/participant-001.csv
"$papilla" study analyse made/STUDY.json made/answers/participant-001.csv -q 2>said.txt
[[ $? == 3 ]] && grep -q 'participant-001.csv: line 8: has no end' said.txt || fail "cut off: $(cat said.txt)"
yes 1 | head -n 20 | "$papilla" study run made/STUDY.json --participant 1 --json run.json -q 2>said.txt || fail "study run: exit $?"
grep -q 'was cut off' said.txt && grep -q 'trial 6 of 14' said.txt || fail "does not go on: $(cat said.txt)"
grep -q '"done": true' run.json || fail "run.json: $(cat run.json)"

# On the page, whose answers are on the disk as well.
"$papilla" study run made/STUDY.json --participant 2 --page --no-open --device sim --play-seconds 0.2 >page.txt 2>page.err &
session=$!
until grep -q 'http:' page.txt; do kill -0 $session || break; done
python3 - "$(grep -o 'http:[^ ]*' page.txt)" <<'PYTHON' || fail "the page: $(cat page.txt page.err)"
import json, os, sys, time, urllib.error, urllib.request
base, token = sys.argv[1].split("/?")
def ask(path, body=None):
    data = None if body is None else json.dumps(body).encode()
    try:
        with urllib.request.urlopen(f"{base}/{path}?{token}", data) as reply:
            return reply.status, reply.read()
    except urllib.error.HTTPError as error:
        return error.code, error.read()
status, page = ask("")
data = json.loads(page.decode().split('id="data">')[1].split("</script>")[0])
assert status == 200 and len(data["trials"]) == 14 and data["place"] == 1 and data["plays"], status
assert ask("pictures/ovals8.png")[1][:4] == b"\x89PNG"
assert ask("pictures/../STUDY.json")[0] == 404
assert ask("play", {"file": "../STUDY.json"})[0] == 409
first = data["trials"][0]["files"][0]
def play_first():
    assert ask("play", {"file": first})[0] == 200
    while json.loads(ask("state")[1])["playing"]:
        time.sleep(0.05)
    return json.loads(ask("state")[1])["failure"]
os.rename("made/" + first, "away.glb")
assert "ended with 3" in play_first(), ask("state")
answers = data["experiments"][data["blocks"][data["trials"][0]["block"]]["experiment"]]["answers"]
status, said = ask("answer", {"place": 1, "answer": answers[0]["value"], "seconds": 1})
assert status == 409 and b"no answer is taken" in said, (status, said)
os.rename("away.glb", "made/" + first)
assert play_first() == "", ask("state")
assert ask("answer", {"place": 1, "answer": "banana", "seconds": 1})[0] == 409
assert ask("answer", "no object")[0] != 200
for place, trial in enumerate(data["trials"], 1):
    answers = data["experiments"][data["blocks"][trial["block"]]["experiment"]]["answers"]
    status, said = ask("answer", {"place": place, "answer": answers[0]["value"], "seconds": 1.5})
    assert status == 200 and json.loads(said)["place"] == place + 1, (status, said)
PYTHON
wait $session || fail "study run --page: exit $?"
[[ $(tail -n +2 made/answers/participant-002.csv | wc -l) == 14 ]] || fail "answers of the page: $(cat made/answers/participant-002.csv)"

"$papilla" study analyse made/STUDY.json made/answers/*.csv -o report.html --pictures pictures --json analysis.json -q || fail "analyse: exit $?"
for key in thresholds factors ratings recognitions; do grep -q "\"$key\"" analysis.json || fail "analysis.json: no $key"; done
grep -q '<h2>Thresholds' report.html || fail "report.html"
sed '5s/,[^,]*,[^,]*,[^,]*$/,melon,1,now/' made/answers/participant-001.csv >damaged.csv
"$papilla" study analyse made/STUDY.json damaged.csv -q 2>said.txt
[[ $? == 3 ]] && grep -q "damaged.csv: line 5: answer: 'melon' is none of" said.txt || fail "damaged: $(cat said.txt)"

"$papilla" study simulate made/STUDY.json -o simulated --runs 5 --json simulated.json -q || fail "simulate: exit $?"
"$papilla" study analyse made/STUDY.json simulated/*.csv -q || fail "analyse of simulated answers: exit $?"
grep -q '"covered"' simulated.json || fail "simulated.json: $(cat simulated.json)"
finish "study"
