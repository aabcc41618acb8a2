"use strict";
// Tables: a head sorts by keyboard too; filters of the overview show some arms, codings and groups of swarms.

for (const head of document.querySelectorAll("table.sortable thead th:not(.no-sort)")) {
  head.tabIndex = 0;
  head.addEventListener("keydown", (event) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();  // a space would scroll
    head.click();
  });
}

for (const form of document.querySelectorAll("form.filters")) {
  const table = document.getElementById(form.dataset.table);
  const said = form.querySelector("output");
  const filter = () => {
    const want = new FormData(form);
    const chosen = (key) => want.get(key) ?? "";
    for (const cell of table.querySelectorAll("[data-case]")) {
      cell.hidden = (chosen("case") && cell.dataset.case !== chosen("case"))
        || (chosen("coding") && cell.dataset.coding !== chosen("coding"));
    }
    const words = chosen("swarm").trim().toLowerCase();
    let count = 0;
    for (const row of table.tBodies[0].rows) {
      row.hidden = (chosen("group") && row.dataset.group !== chosen("group"))
        || (words && !row.dataset.swarm.includes(words));
      count += row.hidden ? 0 : 1;
    }
    said.textContent = `${count} swarms`;
  };
  form.addEventListener("input", filter);
  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("reset", () => setTimeout(filter));
  table.addEventListener("sort-end", filter);
}
