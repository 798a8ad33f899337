"use strict";
const valueIn = (row, column) => {
  const cell = row.cells[column];
  const shown = cell.dataset.value ?? cell.textContent.trim();
  return shown !== "" && Number.isFinite(Number(shown)) ? Number(shown) : shown.toLowerCase();
};
const compare = (a, b) => {
  if (typeof a !== typeof b) return typeof a === "number" ? -1 : 1;
  return typeof a === "number" ? a - b : a.localeCompare(b);
};
const sortBy = (table, cell) => {
  const direction = cell.getAttribute("aria-sort") === "ascending" ? "descending" : "ascending";
  for (const other of cell.parentNode.cells) other.removeAttribute("aria-sort");
  cell.setAttribute("aria-sort", direction);
  const sign = direction === "ascending" ? 1 : -1;
  const rows = [...table.tBodies[0].rows].map((row) => [valueIn(row, cell.cellIndex), row]);
  rows.sort((a, b) => sign * compare(a[0], b[0]));
  const sorted = document.createDocumentFragment();
  for (const [, row] of rows) sorted.append(row);
  table.tBodies[0].append(sorted);
};
for (const table of document.querySelectorAll("table[data-sortable]")) {
  for (const cell of table.tHead.rows[0].cells) {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...cell.childNodes);
    button.addEventListener("click", () => sortBy(table, cell));
    cell.append(button);
  }
}
for (const table of document.querySelectorAll("table[data-filter]")) {
  const label = document.createElement("label");
  const field = document.createElement("input");
  const count = document.createElement("span");
  field.type = "search";
  count.setAttribute("role", "status");
  label.append(table.dataset.filter + " ", field);
  const bar = document.createElement("p");
  bar.className = "filter";
  bar.append(label, " ", count);
  table.parentNode.before(bar);
  const texts = new Map([...table.tBodies[0].rows].map((row) => [row, row.textContent.toLowerCase()]));
  field.addEventListener("input", () => {
    const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const [row, text] of texts) {
      row.hidden = !words.every((word) => text.includes(word));
      shown += row.hidden ? 0 : 1;
    }
    count.textContent = shown + " of " + texts.size + " shown";
  });
}
