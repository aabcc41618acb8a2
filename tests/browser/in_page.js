// What the browser tests ask of a page; it stands in every page that they open, as `inPage`.
"use strict";

addEventListener("securitypolicyviolation", (event) => {
  console.error(`CSP: ${event.violatedDirective} ${event.blockedURI}`);
});

globalThis.inPage = {
  // open what is closed around an element
  open(element) {
    for (let one = element; one; one = one.parentElement) if (one.tagName === "DETAILS") one.open = true;
  },

  // open every part and draw every chart, as scrolling through the page would
  drawEverything() {
    for (const part of document.querySelectorAll("details")) part.open = true;
    for (const figure of figures) if (!figure.dataset.drawn) draw(figure);
  },

  // what plotly holds of a chart: its traces and its layout
  drawn(figure) {
    const {data, layout} = figure.querySelector(".canvas");
    return JSON.parse(JSON.stringify({data, layout}));
  },

  // texts of the cells of the overview that can be seen, by swarm
  cells(table) {
    return [...table.tBodies[0].rows].filter((row) => !row.hidden).map((row) => [
      row.dataset.swarm,
      Object.fromEntries([...row.querySelectorAll("td[data-case]")].filter((cell) => cell.checkVisibility())
        .map((cell) => [`${cell.dataset.case} ${cell.dataset.coding}`, cell.textContent.trim()])),
    ]);
  },

  // begin to wait for the rows' new order; `await inPage.sorted` afterwards
  expectSort(head) {
    const table = head.closest("table");
    inPage.sorted = new Promise((done) => table.addEventListener("sort-end", () => done(), {once: true}));
  },

  slideTo(slider, time) {
    slider.value = time;
    slider.dispatchEvent(new Event("input", {bubbles: true}));
  },

  // here and not in the driver: on a slow machine the motion would end before it has pressed the button again
  async playAndPause(figure) {
    const button = figure.querySelector(".controls button");
    const slider = figure.querySelector("input[type=range]");
    const frame = () => new Promise(requestAnimationFrame), words = [button.textContent];
    button.click();
    words.push(button.textContent);
    while (Number(slider.value) < 0.1) await frame();
    button.click();
    words.push(button.textContent);
    const paused = Number(slider.value);
    for (let k = 0; k < 5; k++) await frame();
    return {words, paused, later: Number(slider.value), clock: figure.querySelector("output").textContent};
  },

  hover(figure, curveNumber, pointNumber) {
    Plotly.Fx.hover(figure.querySelector(".canvas"), [{curveNumber, pointNumber}]);
  },

  // text that leaves the window, or its box where the box cuts it, unless a box around it scrolls
  clipped() {
    const found = new Set();
    const overflow = (element) => getComputedStyle(element).overflowX;
    const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walk.nextNode()) {
      const words = walk.currentNode.textContent.trim(), element = walk.currentNode.parentElement;
      if (!words || element.closest("script, style, svg, .skip, option") || !element.checkVisibility()) continue;
      const around = [];
      for (let one = element; one !== document.body; one = one.parentElement) around.push(one);
      if (around.some((one) => /auto|scroll/.test(overflow(one)))) continue;
      const range = document.createRange();
      range.selectNodeContents(walk.currentNode);
      for (const box of range.getClientRects()) {
        const outside = (frame) => box.left < frame.left - 1 || box.right > frame.right + 1;
        if (outside({left: 0, right: innerWidth})) found.add(`outside: ${words}`);
        if (around.some((one) => overflow(one) !== "visible" && outside(one.getBoundingClientRect()))) {
          found.add(`cut: ${words}`);
        }
      }
    }
    return [...found];
  },

  // words of a chart that its canvas does not show whole
  cutInCharts() {
    return [...document.querySelectorAll("figure.chart")].flatMap((figure) => {
      const canvas = figure.querySelector(".canvas").getBoundingClientRect();
      return [...figure.querySelectorAll("svg text")].filter((words) => {
        const box = words.getBoundingClientRect();
        return words.textContent.trim() && box.width > 0 && !words.closest(".modebar-container, .hoverlayer")
          && (box.left < canvas.left - 1 || box.right > canvas.right + 1
              || box.top < canvas.top - 1 || box.bottom > canvas.bottom + 1);
      }).map((words) => `${figure.dataset.of} ${figure.dataset.kind}: ${words.textContent}`);
    });
  },

  // labels of an axis that lie on each other or on its title
  overlapsInCharts() {
    const common = (a, b, low, high) => Math.min(a[high], b[high]) - Math.max(a[low], b[low]) > 2;
    return [...document.querySelectorAll("figure.chart")].flatMap((figure) => ["x", "y"].flatMap((axis) => {
      const labels = [...figure.querySelectorAll(`.${axis}tick text, .${axis}title`)]
        .map((words) => [words.textContent, words.getBoundingClientRect()]);
      return labels.flatMap(([one, a], k) => labels.slice(k + 1)
        .filter(([, b]) => common(a, b, "left", "right") && common(a, b, "top", "bottom"))
        .map(([other]) => `${figure.dataset.of} ${figure.dataset.kind}: ${one} on ${other}`));
    }));
  },
};
