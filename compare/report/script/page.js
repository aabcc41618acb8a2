"use strict";
// The page's own frame: its data, its two themes, charts drawn when they come into view, printing.

const data = JSON.parse(document.getElementById("data").textContent);
const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
const charts = {};  // kind -> function (figure, what it shows); each script enters its own
const root = document.documentElement;

function colour(name) {
  return getComputedStyle(root).getPropertyValue(`--${name}`).trim();
}

// plotly reads some HTML in labels; names from files must stay text
function text(words) {
  return String(words).replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");
}

function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

let paper = null;  // width of a chart on paper [px], while the page is printed: A4 and US letter hold it

function widthOf(figure) {
  return paper ?? figure.querySelector(".canvas").clientWidth;
}

function narrow(figure) {
  return widthOf(figure) < 560;
}

// what all charts have in common
function layout(more = {}) {
  const axis = {gridcolor: colour("grid"), linecolor: colour("soft"), zerolinecolor: colour("grid"),
                tickcolor: colour("soft"), automargin: true};
  const made = {
    font: {family: "system-ui, sans-serif", size: 13, color: colour("ink")},
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
    margin: {l: 10, r: 10, t: 10, b: 40}, hovermode: "closest", showlegend: false,
    hoverlabel: {bgcolor: colour("card"), bordercolor: colour("soft"), font: {color: colour("ink")}},
    legend: {orientation: "h", x: 0, y: 1.02, yanchor: "bottom", bgcolor: "rgba(0,0,0,0)"},
    ...more,
  };
  for (const name of Object.keys(made)) {
    if (/^[xy]axis\d*$/.test(name)) made[name] = {...axis, ...made[name]};
  }
  if (!made.xaxis) made.xaxis = axis;
  if (!made.yaxis) made.yaxis = axis;
  return made;
}

const config = {displaylogo: false, responsive: false, scrollZoom: false,
                modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"],
                toImageButtonOptions: {format: "svg"}};

function plot(figure, traces, how) {
  const canvas = figure.querySelector(".canvas");
  Plotly.react(canvas, traces, {...how, width: widthOf(figure)}, config);
  for (const button of canvas.querySelectorAll(".modebar-btn")) button.setAttribute("tabindex", "-1");
}

// a row of labelled controls above a chart, made once, so that they keep the keyboard's focus
function controls(figure, made) {
  const bar = figure.querySelector(".controls");
  if (!bar.children.length) bar.append(...made());
}

function choice(label, options, chosen, changed) {
  const select = make("select");
  for (const [value, words] of options) {
    const option = make("option", {value}, words);
    option.selected = value === chosen;
    select.append(option);
  }
  select.addEventListener("change", () => changed(select.value));
  return make("label", {}, `${label} `, select);
}

function tick(label, checked, changed) {
  const box = make("input", {type: "checkbox"});
  box.checked = checked;
  box.addEventListener("change", () => changed(box.checked));
  return make("label", {}, box, ` ${label}`);
}

function draw(figure) {
  charts[figure.dataset.kind](figure, data[figure.dataset.of][figure.dataset.kind]);
  figure.dataset.drawn = "yes";
}

const figures = [...document.querySelectorAll("figure.chart")];
const eye = new IntersectionObserver((entries) => {
  for (const entry of entries) {
    if (!entry.isIntersecting) continue;
    eye.unobserve(entry.target);
    draw(entry.target);
  }
}, {rootMargin: "400px"});

function drawAgain() {
  for (const figure of figures) {
    if (!figure.dataset.drawn) continue;
    if (figure.checkVisibility()) draw(figure);
    else {  // in a closed part: when it is opened
      delete figure.dataset.drawn;
      eye.observe(figure);
    }
  }
}

// what fits a chart depends on its width, so plotly's own way to follow the window is not enough
let width = innerWidth, waiting = 0;
addEventListener("resize", () => {
  if (innerWidth === width) return;  // a phone's bars come and go
  width = innerWidth;
  clearTimeout(waiting);
  waiting = setTimeout(drawAgain, 100);
});

// light or dark: as the system asks, or as the button says
function setTheme(theme) {
  root.dataset.theme = theme;
  const button = document.getElementById("theme");
  button.textContent = theme === "dark" ? "Light" : "Dark";
  button.setAttribute("aria-label", theme === "dark" ? "Use light colours" : "Use dark colours");
  drawAgain();
}

const dark = matchMedia("(prefers-color-scheme: dark)");
document.getElementById("theme").addEventListener("click", () => {
  setTheme(root.dataset.theme === "dark" ? "light" : "dark");
});
dark.addEventListener("change", () => setTheme(dark.matches ? "dark" : "light"));

// paper: light colours, and every chart that is in an open part
let before = null;
addEventListener("beforeprint", () => {
  before = root.dataset.theme;
  root.dataset.theme = "light";
  paper = 690;
  for (const figure of figures) if (!figure.closest("details:not([open])")) draw(figure);
});
addEventListener("afterprint", () => {
  paper = null;
  setTheme(before);
});

// a link to a closed part, or to the heading above one, opens it
function openTarget() {
  const id = decodeURIComponent(location.hash.slice(1));
  const target = id && document.getElementById(id);
  if (!target) return;
  for (let part = target; part; part = part.parentElement) if (part.tagName === "DETAILS") part.open = true;
  const below = document.querySelector(`details[data-of="${CSS.escape(id)}"]`);
  if (below) below.open = true;
  target.scrollIntoView();
}
for (const button of document.querySelectorAll("button[data-all]")) {
  button.addEventListener("click", () => {
    for (const part of document.querySelectorAll(`details.${button.dataset.all}`)) part.open = true;
  });
}
addEventListener("hashchange", openTarget);

// a page that is loaded again goes to the address's target: the place where the browser left it moves
// when charts are drawn
if (location.hash) history.scrollRestoration = "manual";
addEventListener("load", openTarget);

addEventListener("DOMContentLoaded", () => {
  setTheme(dark.matches ? "dark" : "light");
  if (matchMedia("(max-width: 60rem)").matches) document.querySelector("details.chapters").open = false;
  for (const figure of figures) eye.observe(figure);
  openTarget();
});
