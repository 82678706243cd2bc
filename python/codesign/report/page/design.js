/** The selected design: its card beside the chart, its parts in 3-D, its flight. */
// Light to dark with monotone lightness: a part reads as a lit body, and the order survives color blindness and gray print.
const STRESS_SCALE = [[0, '#e3e6e8'], [0.2, '#f4e3a1'], [0.45, '#f2ac42'], [0.7, '#d2601a'], [1, '#7a1616']];

function card(i) {
  const d = designs[i], box = element('card');
  if (!box) return;
  const tags = roles(d).map(r => `<span class="tag${r === 'best compromise' || r === 'original' ? ' plain' : ''}">${escaped(r)}</span>`);
  if (d.status !== FEASIBLE) tags.push(`<span class="tag warn">${STATUS[d.status]}</span>`);
  const variables = report.variables.map((v, k) => {
    const place = value => 100 * ((v.names ? v.names.indexOf(value) : value) - v.min) / ((v.max - v.min) || 1);
    const range = v.names ? `one of ${v.names.join(', ')}` : `between ${plain(v.min)} and ${plain(v.max)}`;
    const was = original && d !== original ? `<u style="left:${place(original.x[k])}%" title="original: ${plain(original.x[k])}"></u>` : '';
    return `<div class="row"><span>${escaped(v.label)}</span><b>${withUnit(plain(d.x[k]), v.unit)}</b>` +
      `<div class="track" role="img" aria-label="${escaped(range)}">${was}<i style="left:${place(d.x[k])}%"></i></div></div>`;
  });
  const objectives = report.objectives.map((o, k) =>
    `<div class="row"><span>${escaped(o.label)}</span><b>${withUnit(number(d.f[k]), o.unit)}<span class="delta">${percent(change(d, k))}</span></b></div>`);
  const constraint = (c, k) => {
    const verdict = below(c, d.c[k]) ? '<span class="bad"> overlap</span>' : !known(d.c[k]) || !c.rule ? '' : d.g[k] > 0 ? '<span class="bad"> violated</span>' : '<span class="good"> ✓</span>';
    return `<div class="row" title="${escaped(c.meaning)}"><span>${escaped(c.label)} <small>${escaped(c.rule)}</small></span><b>${withUnit(number(d.c[k], 3), c.unit)}${verdict}</b></div>`;
  };
  const rows = wanted => report.constraints.map((c, k) => Boolean(c.rule) === wanted && known(d.c[k]) ? constraint(c, k) : '').join('');
  const [constraints, watched] = [rows(true), rows(false)];
  box.innerHTML = `<header><h2>${name(d)}</h2><span class="step"><button type="button" class="quiet" data-step="-1" aria-label="Previous best compromise" title="Previous best compromise">←</button>` +
    `<button type="button" class="quiet" data-step="1" aria-label="Next best compromise" title="Next best compromise">→</button></span></header>` +
    `<p class="tags">${tags.join('')}</p>${against(d)}` +
    `<div class="group"><h3>Parameters${original && d !== original ? ' <small>– mark: original</small>' : ''}</h3>${variables.join('')}</div>` +
    (d.f.some(known) ? `<div class="group"><h3>Objectives${original && d !== original ? ', against the original' : ''}</h3>${objectives.join('')}</div>` : '') +
    (constraints ? `<div class="group"><h3>Constraints</h3>${constraints}</div>` : '') +
    (watched ? `<div class="group"><h3>Watched, without a limit</h3>${watched}</div>` : '') +
    (d.files ? `<div class="group"><h3>Files</h3>${d.files.map(f => `<div class="row"><a href="${escaped(f.href)}">${escaped(f.label)}</a><small>${escaped(f.size)}</small></div>`).join('')}</div>` : '') +
    `<div class="group"><button type="button" class="copy" data-copy="${escaped(command(d))}">Copy export command</button></div>`;
}
const command = d => d.id !== null ? `${report.command} --design ${d.id} --out design-${d.id}`
  : report.command_original + ' ' + report.variables.map((v, k) => `--set ${v.key}=${d.x[k]}`).join(' ') + ' --out design-original';

/** What speaks against building a design. */
function against(d) {
  if (!d.against.length) return '';
  return `<div class="reason"><b>${d.barred ? 'Not to be built' : 'Not to be built yet'}</b><ul>${d.against.map(text => `<li>${escaped(text)}</li>`).join('')}</ul></div>`;
}

const PART_FACTS = [['Mass', 'kg', 4, 1], ['Safety factor', '', 3, 1], ['Peak stress', 'MPa', 3, 1e-6], ['Stress error', 'MPa', 2, 1e-6], ['Displacement', 'mm', 3, 1e3]];

function drawParts(i) {
  const box = element('parts'), d = designs[i];
  if (!box) return;
  element('parts-name').textContent = name(d);
  const detail = report.details[d.detail];
  const cards = report.parts.map((part, k) => {
    const values = d.p[k];
    if (!values) return '';
    const facts = PART_FACTS.map(([label, unit, digits, factor], n) => !known(values[n]) ? '' : `<div><dt>${label}</dt><dd>${withUnit(number(values[n] * factor, digits), unit)}</dd>${searched(d, k, n, factor, digits)}${before(d, k, n, factor, digits)}</div>`);
    const strength = (d.s[k] || []).map(text => `<p class="count">${escaped(text)}.</p>`).join('');
    const made = report.about[d.about]?.[k] || {};
    const about = strength + [made.material, made.load && `Load: ${made.load}`].filter(Boolean).map(text => `<p class="count">${escaped(text)}.</p>`).join('') + (made.warning ? `<p class="count bad">${escaped(made.warning)}</p>` : '');
    const view = detail && detail.parts[part.key] ? `<div class="solid" id="solid-${k}" role="img" aria-label="${escaped(part.label)} of ${name(d)}, colored by stress; drag to turn"></div>${stressScale(detail.parts[part.key])}${d.searched ? '<p class="count">Colors are those of the mesh of the search; the numbers are of the finer one.</p>' : ''}` : '';
    return `<article class="part"><h3>${escaped(part.label)}</h3>${view}<dl class="facts">${facts.join('')}</dl>${about}</article>`;
  });
  document.querySelectorAll('.solid').forEach(node => window.Plotly?.purge(node));
  box.innerHTML = cards.join('') || '<p class="absent">No part was built for this design.</p>';
  element('parts-absent').innerHTML = detail || !cards.join('') ? '' : absent('The 3-D view with stress and the flight histories are');
  report.parts.forEach((part, k) => whenVisible(element(`solid-${k}`), node => drawSolid(node, detail.parts[part.key])));
}

/** The number that the search had, where a finer mesh has confirmed another. */
function searched(d, k, n, factor, digits) {
  const was = d.searched?.[k]?.[n];
  return known(was) && was !== d.p[k][n] ? `<dd class="was">in the search ${number(was * factor, digits)}</dd>` : '';
}

/** The same number of the original's part, and the change from it. */
function before(d, k, n, factor, digits) {
  const was = original && d !== original ? original.p[k]?.[n] : null, now = d.p[k][n];
  if (!known(was)) return '';
  return `<dd class="was">original ${number(was * factor, digits)} ${was && n < 2 ? percent((now - was) / Math.abs(was), 0) : ''}</dd>`;
}

function absent(what) {
  const kept = designs.map((d, i) => i).filter(i => report.details[designs[i].detail]);
  kept.sort((a, b) => (b === report.recommended) - (a === report.recommended));
  if (!kept.length) return `<p class="absent">${what} not in this report.</p>`;
  const links = kept.map(i => `<button type="button" data-select="${i}">${name(designs[i])}</button> (${escaped(roles(designs[i])[0] || '')})`);
  return `<p class="absent">${what} kept for ${links.join(', ')}. For any other design, use <code>codesign view</code>.</p>`;
}

function decode(text, type) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  return new type(bytes.buffer);
}

/** Camera position; farther away in a box that is narrower than high. */
function eye(node) {
  const far = Math.max(1, node.clientHeight / node.clientWidth);
  return {x: 1.05 * far, y: -1.45 * far, z: 0.95 * far};
}

/** Sides of the part's box for plotly, scaled so that the part stays inside the view however it is turned. */
const DIAGONAL = 2.4;
function ratio(...coordinates) {
  const sides = coordinates.map(values => values.reduce((high, v) => Math.max(high, v), -Infinity) - values.reduce((low, v) => Math.min(low, v), Infinity));
  const [x, y, z] = sides.map(side => DIAGONAL * side / (Math.hypot(...sides) || 1));
  return {x, y, z};
}

/** The scale under a part: unloaded to the peak that decides its safety factor. */
const stressScale = solid => `<div class="scale" role="img" aria-label="Colors from 0 to ${number(solid.peak * 1e-6, 3)} MPa"><span>0</span><i style="background:linear-gradient(90deg,${STRESS_SCALE.map(([at, hex]) => `${hex} ${100 * at}%`).join()})"></i><span>${number(solid.peak * 1e-6, 3)} MPa</span></div>`;

function drawSolid(node, solid) {
  const mesh = solid.decoded ??= decodedSolid(solid);
  const hidden = {visible: false, showspikes: false};
  plotly().newPlot(node, [{
    type: 'mesh3d', x: mesh.x, y: mesh.y, z: mesh.z, i: mesh.i, j: mesh.j, k: mesh.k, facecolor: mesh.colors, text: mesh.text, hovertemplate: '%{text} MPa<extra></extra>',
    lighting: {ambient: 1, diffuse: 0, specular: 0, fresnel: 0},
  }], layout({margin: {l: 0, r: 0, t: 0, b: 0}, scene: {xaxis: hidden, yaxis: hidden, zaxis: hidden, aspectmode: 'manual', aspectratio: mesh.ratio, dragmode: 'orbit', camera: {eye: eye(node), projection: {type: 'orthographic'}}}}), settings);
}

/** Arrays for plotly, with a color for each triangle: that of its stress, shaded here because plotly's lights fail without perspective. */
function decodedSolid(solid) {
  const grid = decode(solid.points, Uint16Array), faces = decode(solid.faces, solid.wide ? Uint32Array : Uint16Array);
  const stress = Float32Array.from(decode(solid.stress, Uint16Array), s => s / 65535 * solid.highest);
  const coordinate = k => Float32Array.from({length: grid.length / 3}, (_, n) => solid.low[k] + grid[3 * n + k] * solid.step);
  const corner = k => Uint32Array.from({length: faces.length / 3}, (_, n) => faces[3 * n + k]);
  const [x, y, z, i, j, k] = [coordinate(0), coordinate(1), coordinate(2), corner(0), corner(1), corner(2)];
  const colors = Array.from(i, (a, n) => {
    const b = j[n], c = k[n];
    const [ux, uy, uz, vx, vy, vz] = [x[b] - x[a], y[b] - y[a], z[b] - z[a], x[c] - x[a], y[c] - y[a], z[c] - z[a]];
    const [nx, ny, nz] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const facing = (nx * LIGHT[0] + ny * LIGHT[1] + nz * LIGHT[2]) / (Math.hypot(nx, ny, nz) || 1);
    return stressColor((stress[a] + stress[b] + stress[c]) / 3 / (solid.peak || 1), 0.8 + 0.2 * facing);
  });
  return {x, y, z, i, j, k, colors, ratio: ratio(x, y, z), text: Array.from(stress, s => number(s * 1e-6, 3))};
}

const LIGHT = [0.3, -0.55, 0.78];
const STRESS_STOPS = STRESS_SCALE.map(([at, hex]) => [at, [1, 3, 5].map(n => parseInt(hex.slice(n, n + 2), 16))]);

/** Color of a stress relative to the peak, darkened by `shade`. */
function stressColor(share, shade) {
  const at = Math.min(Math.max(share, 0), 1), n = Math.max(1, STRESS_STOPS.findIndex(([stop]) => stop >= at));
  const [[low, from], [high, to]] = [STRESS_STOPS[n - 1], STRESS_STOPS[n]], part = (at - low) / (high - low);
  return `rgb(${from.map((c, m) => Math.round(shade * (c + part * (to[m] - c)))).join()})`;
}

const SERIES = ['series-1', 'series-2', 'series-3', 'series-4'];

function drawFlight(i) {
  const box = element('histories'), d = designs[i];
  if (!box) return;
  element('flight-name').textContent = name(d);
  const flight = report.details[d.detail]?.flight, reference = original && report.details[original.detail]?.flight;
  box.querySelectorAll('.history > div').forEach(node => window.Plotly?.purge(node));
  const facts = report.flight_facts.map((f, k) => !known(d.fl[k]) ? '' : `<div><dt>${escaped(f.label)}</dt><dd>${withUnit(number(d.fl[k], 3), f.unit)}</dd></div>`);
  element('flight-facts').innerHTML = facts.join('');
  if (!flight) {
    box.innerHTML = element('parts-absent')?.innerHTML ? '' : absent('Flight histories are');
    return;
  }
  box.innerHTML = flight.charts.map((c, k) => `<article class="history"><h3>${escaped(c.label)} <small>${escaped(c.unit)}</small></h3><div id="history-${k}" role="img" aria-label="${escaped(c.label)} over time"></div></article>`).join('');
  const other = reference && reference !== flight ? reference : null;
  flight.charts.forEach((chart, k) => whenVisible(element(`history-${k}`), node => drawHistory(node, flight, chart, other, k)));
}

const decoded = (flight, series) => (series.decoded ??= Array.from(decode(series.values, Float32Array)));

function drawHistory(node, flight, chart, reference, k) {
  const time = decoded(flight, flight.time), traces = [];
  const alone = chart.series.length === 1;
  if (reference && alone && reference.charts[k]) traces.push({
    type: 'scatter', mode: 'lines', x: decoded(reference, reference.time), y: decoded(reference, reference.charts[k].series[0]), name: 'original',
    line: {color: color('original'), width: 1.3, dash: 'dot'}, hovertemplate: '%{y:.3g} original<extra></extra>',
  });
  chart.series.forEach((series, n) => traces.push({
    type: 'scatter', mode: 'lines', x: time, y: decoded(flight, series), name: series.label, line: {color: color(SERIES[n % 4]), width: 1.6},
    hovertemplate: `%{y:.3g} ${alone ? 'this design' : escaped(series.label)}<extra></extra>`,
  }));
  const legend = {orientation: 'h', x: 1, xanchor: 'right', y: 1.02, yanchor: 'bottom', font: font(), bgcolor: 'rgba(0,0,0,0)'};
  plotly().newPlot(node, traces, layout({
    margin: {l: 48, r: 8, t: traces.length > 1 ? 24 : 8, b: 38}, xaxis: axis('Time (s)', {title: {text: 'Time (s)', font: font(), standoff: 4}}),
    yaxis: axis('', {rangemode: chart.zero ? 'tozero' : 'normal'}), showlegend: traces.length > 1, legend, hovermode: 'x unified',
  }), settings);
}
