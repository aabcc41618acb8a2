"use strict";
// Position to jerk of one joint, motion beside motion, from their exact polynomial pieces.

const MOTIONS = {published: ["red", "dash"], family: ["green", "solid"], fastest: ["blue", "dot"], given: ["orange", "solid"]};
const SAMPLES = 500;  // over a motion

// value of a derivative of ascending coefficients at a local time
function derivative(coefficients, order, t) {
  let value = 0;
  for (let k = coefficients.length - 1; k >= order; k--) {
    let factor = coefficients[k];
    for (let i = 0; i < order; i++) factor *= k - i;
    value = value * t + factor;
  }
  return value;
}

// times and values of a curve; a motion of too many pieces comes as the extremes of short intervals
function sampled(motion, joint, order) {
  if (motion.curves) return motion.curves[joint][order];
  const total = motion.durations.reduce((sum, one) => sum + one, 0);
  const t = [], x = [];
  let start = 0;
  motion.durations.forEach((duration, k) => {
    const count = Math.max(2, Math.ceil(SAMPLES * duration / total));
    for (let i = 0; i <= count; i++) {
      const local = duration * i / count;
      t.push(start + local);
      x.push(derivative(motion.pieces[k][joint], order, local));
    }
    start += duration;
  });
  return [t, x];
}

// without a limit one motion can be so steep that the others would be flat: it is cut off, a double click shows it whole
function cropped(extents, low, high) {
  const next = extents.toSorted((a, b) => b - a)[1];
  return low === null && high === null && Math.max(...extents) > 20 * next && next > 0 ? {range: [-1.5 * next, 1.5 * next]} : {};
}

// what one joint's picture shows below each other: position to jerk, then torque and the tool's speed where they are limited
function panelsOf(found, joint) {
  const one = found.joints[joint];
  const own = found.quantities.map((quantity, order) => ({
    quantity, unit: one.units[order], limits: one.limits[order], segments: one.segments?.[order] ?? null,
    curve: (motion) => sampled(motion, joint, order),
  }));
  const more = (found.panels ?? []).map(({quantity, joints, curves}) => {
    const which = Math.min(joint, joints.length - 1);  // the tool's speed is that of all joints
    return {quantity, ...joints[which], curve: (motion) => curves[found.motions.indexOf(motion)][which]};
  });
  return [...own, ...more];
}

// the limits at a time; where two segments meet, both allow what one of them does
function limitsAt(panel, passages, time) {
  if (!panel.segments) return panel.limits;
  const near = 1e-6 * passages.at(-1);
  const held = panel.segments.filter((_, k) => time >= passages[k] - near && time <= passages[k + 1] + near);
  const side = (which, pick) => (held.some((pair) => pair[which] === null) ? null : pick(...held.map((pair) => pair[which])));
  return [side(0, Math.min), side(1, Math.max)];
}

// limits that change from segment to segment, at the times of one motion
function limitSteps(panel, passages, axis) {
  return [0, 1].map((which) => ({
    type: "scatter", mode: "lines", yaxis: axis, showlegend: false, hoverinfo: "skip", name: "limit",
    x: panel.segments.flatMap((_, k) => [passages[k], passages[k + 1]]),
    y: panel.segments.flatMap((pair) => [pair[which], pair[which]]),
    line: {color: colour("ink"), dash: "longdash", width: 1},
  })).filter((trace) => trace.y.some((value) => value !== null));
}

// zones and windows of the waypoints: as wide as the window, as high as the zone
function zoneBoxes(found, joint) {
  const {zones = [], waypoints} = found.joints[joint], windows = found.windows ?? [], made = [];
  const total = Math.max(...found.motions.map((motion) => motion.passages.at(-1)));
  waypoints.forEach((waypoint, k) => {
    const zone = zones[k] ?? null, window = windows[k] ?? null;
    if (!zone && !window) return;
    const spans = window ? [[window[0], window[1] ?? total, "purple"]]
      : found.motions.map((motion) => [motion.passages[k] - 0.008 * total, motion.passages[k] + 0.008 * total, MOTIONS[motion.kind][0]]);
    for (const [x0, x1, tint] of spans) {
      const [y0, y1] = zone ?? [waypoint, waypoint];
      made.push({type: "rect", xref: "x", yref: "y", x0, x1, y0, y1, name: `waypoint ${k + 1}`,
                 line: {color: colour(tint), width: y0 < y1 && x0 < x1 ? 1.5 : 3},
                 fillcolor: `${colour(tint)}40`, layer: "below"});
    }
  });
  return made;
}

// where the last motion stands still because a wait is asked for
function waitsOf(found, panels) {
  const {passages} = found.motions.at(-1);
  return (found.waits ?? []).flatMap((wait, k) => (wait > 0 ? [{
    type: "rect", xref: "x", yref: "paper", x0: passages[k], x1: passages[k] + wait, y0: 0.14 / panels.length, y1: 1, name: "wait",
    line: {width: 0}, fillcolor: `${colour("soft")}33`, layer: "below",
  }] : []));
}

// what the marks of this picture mean
function marksOf(found, panels, made) {
  const stepped = panels.some((panel) => panel.segments) && found.motions.length > 1;
  return ["dashed: limits" + (stepped ? ", at the times of the last motion" : ""), "thick: over a limit",
          ...(made.boxes ? ["boxes: zones and windows of waypoints"] : []), ...(made.waits ? ["grey: waits"] : [])].join("; ");
}

charts.motion = (figure, found) => {
  const moving = found.joints.map((_, j) => j).filter((j) => found.joints[j].moves);
  const joint = Number(figure.dataset.joint ?? found.first ?? moving[0] ?? 0);
  const again = (value) => {
    figure.dataset.joint = value;
    draw(figure);
  };
  controls(figure, () => [
    choice("joint", found.joints.map((one, j) => [String(j), one.name]), String(joint), again),
  ]);
  const {name, waypoints} = found.joints[joint], panels = panelsOf(found, joint);
  const zones = zoneBoxes(found, joint), waits = waitsOf(found, panels);
  const traces = [], shapes = [...zones, ...waits], axes = {};
  if (zones.length) {  // an axis is as long as its curves: a line that is not seen holds the boxes
    traces.push({type: "scatter", mode: "lines", x: zones.flatMap((one) => [one.x0, one.x1]), y: zones.flatMap((one) => [one.y0, one.y1]),
                 yaxis: "y", showlegend: false, hoverinfo: "skip", name: "room", line: {width: 0}});
  }
  panels.forEach((panel, order) => {
    const {quantity, unit} = panel, axis = order ? `y${order + 1}` : "y";
    const [low, high] = panel.limits;
    const extents = [];
    for (const motion of found.motions) {
      const [tint, dash] = MOTIONS[motion.kind];
      const [t, x] = panel.curve(motion);
      const title = fold(motion.title, narrow(figure) ? 40 : 90);
      extents.push(Math.max(...x.map(Math.abs)));
      traces.push({type: "scatter", mode: "lines", x: t, y: x, yaxis: axis, name: title, legendgroup: motion.kind,
                   showlegend: order === 0, line: {color: colour(tint), dash, width: 2},
                   hovertemplate: `${quantity} %{y:.4g} ${unit} at %{x:.4f} s<extra></extra>`});
      const over = x.map((value, i) => {
        const [least, most] = limitsAt(panel, motion.passages, t[i]);
        const slack = motion.slack * Math.max(Math.abs(least ?? 0), Math.abs(most ?? 0));
        return (most !== null && value > most + slack) || (least !== null && value < least - slack) ? value : null;
      });
      if (over.some((value) => value !== null)) {
        traces.push({type: "scatter", mode: "lines", x: t, y: over, yaxis: axis, legendgroup: motion.kind,
                     showlegend: false, hoverinfo: "skip", line: {color: colour("red"), width: 6}, opacity: 0.55});
      }
      if (order === 0) {
        traces.push({type: "scatter", mode: "markers", x: motion.passages, y: waypoints, yaxis: axis, legendgroup: motion.kind,
                     showlegend: false, text: waypoints.map((_, k) => String(k + 1)),
                     hovertemplate: "waypoint %{text} at %{x:.4f} s<extra></extra>", marker: {color: colour(tint), size: waypoints.length > 40 ? 3 : 7}});
      }
    }
    const extent = Math.max(...extents);
    if (panel.segments) traces.push(...limitSteps(panel, found.motions.at(-1).passages, axis));
    for (const limit of panel.segments ? [] : [low, high]) {
      // a position limit far away would flatten the curve
      if (limit === null || (order === 0 && Math.abs(limit) > 2 * extent)) continue;
      shapes.push({type: "line", xref: "paper", x0: 0, x1: 1, yref: axis, y0: limit, y1: limit,
                   line: {color: colour("ink"), dash: "longdash", width: 1}});
    }
    const height = 1 / panels.length, top = 1 - order * height;
    axes[order ? `yaxis${order + 1}` : "yaxis"] = {
      domain: [top - 0.86 * height, top], anchor: "x",
      title: {text: `${quantity}<br>[${unit}]`, font: {size: 12}}, nticks: 5,
      ...(panel.segments ? {} : cropped(extents, low, high)),
    };
  });
  const marks = marksOf(found, panels, {boxes: zones.length, waits: waits.length});
  plot(figure, traces, layout({
    height: 160 * panels.length, showlegend: true, shapes, hovermode: "x", ...axes,
    margin: {l: 70, r: 10, t: 10, b: 40},
    legend: {x: 0, y: 1.02, yanchor: "bottom"},
    xaxis: {title: {text: fold(`time [s]; ${name}; ${marks}`, narrow(figure) ? 34 : 120)}, anchor: `y${panels.length}`},
  }));
};
