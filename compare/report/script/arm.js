"use strict";
// The arm as a stick figure in space: it can be turned, zoomed and played, motion beside motion in true time.

const players = new Map();  // figure -> what runs

charts.arm = (figure, found) => {
  const longest = Math.max(...found.motions.map((motion) => motion.seconds));
  const player = players.get(figure) ?? {time: 0, running: false, last: 0};
  players.set(figure, player);
  const ink = colour("ink");
  const traces = [];
  for (const motion of found.motions) {
    const [tint] = MOTIONS[motion.kind];
    const tip = motion.frames.map((frame) => frame.at(-1));
    traces.push({type: "scatter3d", mode: "lines", ...columns(tip), showlegend: false, hoverinfo: "skip",
                 legendgroup: motion.kind, line: {color: colour(tint), width: 2}});
    traces.push({type: "scatter3d", mode: "lines+markers", ...columns(frameAt(motion, player.time)),
                 name: fold(motion.title, narrow(figure) ? 40 : 90), legendgroup: motion.kind, hoverinfo: "skip",
                 line: {color: colour(tint), width: 8}, marker: {color: colour(tint), size: 3}});
  }
  const many = found.stops.length > 40;
  traces.push({type: "scatter3d", mode: many ? "markers" : "markers+text", ...columns(found.stops), name: "waypoints",
               text: found.stops.map((_, k) => String(k + 1)), textfont: {color: ink},
               hovertemplate: "waypoint %{text}<extra></extra>", marker: {color: ink, size: many ? 2 : 4, symbol: "diamond"}});
  for (const [k, radius] of found.balls ?? []) traces.push(ball(found.stops[k], radius, `within ${1000 * radius} mm of waypoint ${k + 1}`));
  const axis = {color: colour("soft"), gridcolor: colour("grid"), zerolinecolor: colour("grid"), showspikes: false};
  const canvas = figure.querySelector(".canvas");
  const camera = canvas.layout?.scene?.camera ?? {eye: {x: 1.65, y: -1.9, z: 0.9}};
  plot(figure, traces, layout({
    height: narrow(figure) ? 480 : 600, showlegend: true, margin: {l: 0, r: 0, t: 0, b: 0},
    legend: {x: 0, y: 1.02, yanchor: "bottom"},
    scene: {aspectmode: "data", camera, xaxis: {...axis, title: {text: "x [m]"}},
            yaxis: {...axis, title: {text: "y [m]"}}, zaxis: {...axis, title: {text: "z [m]"}}},
  }));

  controls(figure, () => playing(canvas, found, player, longest));
};

// a zone of the tool, as three great circles
function ball(centre, radius, words) {
  const turn = Array.from({length: 49}, (_, i) => 2 * Math.PI * i / 48), points = [];
  for (const [a, b] of [[0, 1], [1, 2], [2, 0]]) {
    for (const angle of turn) {
      const point = [...centre];
      point[a] += radius * Math.cos(angle);
      point[b] += radius * Math.sin(angle);
      points.push(point);
    }
    points.push([null, null, null]);
  }
  return {type: "scatter3d", mode: "lines", ...columns(points), name: words, hoverinfo: "name", line: {color: colour("purple"), width: 3}};
}

// a button, a slider and a clock
function playing(canvas, found, player, longest) {
  const button = make("button", {type: "button"}, "Play");
  const slider = make("input", {type: "range", min: 0, max: longest, step: longest / 500, value: 0,
                                "aria-label": "time in seconds"});
  const clock = make("output");
  const show = () => {
    slider.value = player.time;
    button.textContent = player.running ? "Pause" : "Play";
    clock.textContent = `${player.time.toFixed(2)} s of ${longest.toFixed(2)} s`;
    const moving = found.motions.map((motion) => columns(frameAt(motion, player.time)));
    const update = {x: moving.map((one) => one.x), y: moving.map((one) => one.y), z: moving.map((one) => one.z)};
    Plotly.restyle(canvas, update, found.motions.map((_, k) => 2 * k + 1));
  };
  const step = (now) => {
    if (!player.running) return;
    player.time = Math.min(player.time + (now - player.last) / 1000, longest);
    player.last = now;
    player.running = player.time < longest;
    show();
    requestAnimationFrame(step);
  };
  button.addEventListener("click", () => {
    player.running = !player.running;
    if (player.running && player.time >= longest) player.time = 0;
    player.last = performance.now();
    show();
    requestAnimationFrame(step);
  });
  slider.addEventListener("input", () => {
    player.time = Number(slider.value);
    show();
  });
  clock.textContent = `0.00 s of ${longest.toFixed(2)} s`;
  return [button, slider, clock];
}

function columns(points) {
  return {x: points.map((p) => p[0]), y: points.map((p) => p[1]), z: points.map((p) => p[2])};
}

// the chain of points at a time, on straight lines between stored frames
function frameAt(motion, time) {
  const last = motion.frames.length - 1;
  const at = Math.min(Math.max(time / motion.seconds, 0), 1) * last;
  const k = Math.min(Math.floor(at), last - 1), share = at - k;
  return motion.frames[k].map((p, i) => p.map((x, c) => x + share * (motion.frames[k + 1][i][c] - x)));
}
