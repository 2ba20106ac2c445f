// SPDX-License-Identifier: MIT
// Tabs as WAI-ARIA describes them: arrow keys move, one panel is shown.

const tabsOf = (list) => [...list.querySelectorAll('[role=tab]:not([hidden])')];

function choose(list, chosen) {
  for (const tab of list.querySelectorAll('[role=tab]')) {
    const is = tab === chosen;
    tab.setAttribute('aria-selected', String(is));
    tab.tabIndex = is ? 0 : -1;
    document.getElementById(tab.getAttribute('aria-controls')).hidden = !is;
  }
  list.dispatchEvent(new CustomEvent('choose', { detail: chosen.id }));
}

function step(list, event) {
  const tabs = tabsOf(list), now = tabs.indexOf(document.activeElement);
  const next = { ArrowRight: now + 1, ArrowLeft: now - 1, Home: 0, End: tabs.length - 1 }[event.key];
  if (next === undefined || now < 0) return;
  event.preventDefault();
  event.stopPropagation();
  const tab = tabs[(next + tabs.length) % tabs.length];
  tab.focus();
  choose(list, tab);
}

/** @returns a function that shows the panel of a tab by its id */
export function startTabs() {
  for (const list of document.querySelectorAll('[data-tabs]')) {
    list.addEventListener('click', (e) => { const tab = e.target.closest('[role=tab]'); if (tab) choose(list, tab); });
    list.addEventListener('keydown', (e) => step(list, e));
    choose(list, tabsOf(list)[0]);
  }
}

export function showTab(id) {
  const tab = document.getElementById(id);
  choose(tab.closest('[data-tabs]'), tab);
}
