/** The trade-off chart: two objectives as axes, a third as color. */
const COMPARED = ['series-4', 'series-2', 'series-3', 'series-1'];
const front = {x: 0, y: Math.min(1, report.objectives.length - 1), ready: false, last: null};

const points = test => designs.map((d, i) => i).filter(i => test(designs[i]) && known(designs[i].f[front.x]) && known(designs[i].f[front.y]));
const third = () => report.objectives.map((o, k) => k).find(k => k !== front.x && k !== front.y);

const MOST_DOTS = 2000;  // behind the front: of more, one for each spot of the chart
const SPOTS = 150;  // along each axis; fewer where still more than MOST_DOTS are left

/** Of many designs behind the front those that are drawn, and the size of a spot (share of each axis; 0: all are drawn). */
function thinned(indices, ranges) {
  let drawn = indices, spots = SPOTS;
  for (; drawn.length > MOST_DOTS; spots = Math.floor(spots / 1.2)) {
    const taken = new Set();
    drawn = indices.filter(i => {
      const spot = [front.x, front.y].map((k, a) => Math.floor(spots * (designs[i].f[k] - ranges[a][0]) / (ranges[a][1] - ranges[a][0]))).join();
      return taken.size < taken.add(spot).size;
    });
    if (drawn.length <= MOST_DOTS) return [drawn, 1 / spots];
  }
  return [drawn, 0];
}

/** The dots behind the front, infeasible and other ones, within what the axes show; and a sentence on those left out. */
function dots(ranges) {
  const groups = [points(d => d.status === INFEASIBLE), points(d => d.status === SKIPPED || d.status === FEASIBLE && !d.front)];
  const inside = i => [front.x, front.y].every((k, a) => designs[i].f[k] >= ranges[a][0] && designs[i].f[k] <= ranges[a][1]);
  const seen = groups.flat().filter(inside), [kept, spot] = thinned(seen, ranges);
  const [away] = thinned(groups.flat().filter(i => !inside(i)), ranges), drawn = new Set([...kept, ...away]);
  const left = seen.length - kept.length;
  front.thinned = left ? `${left} of ${seen.length} designs in view behind the best compromises are not drawn: each is within ${percent(spot).slice(1)} of both axes of one that is. Zoom in to see more; the table has all.` : '';
  return groups.map(group => group.filter(i => drawn.has(i)));
}

/** Draws the dots anew for what the axes show after a zoom. */
function drawDots() {
  const plot = element('front'), told = front.thinned;
  const groups = dots([plot.layout.xaxis.range, plot.layout.yaxis.range]);
  if (!told && !front.thinned) return;
  const traces = groups.map(group => markers(group, {}, ''));
  const of = key => traces.map(trace => trace[key]);
  plotly().restyle(plot, {x: of('x'), y: of('y'), text: of('text'), customdata: of('customdata')}, [0, 1]);
  sayThinned();
}
const sayThinned = () => { element('front-thinned').textContent = front.thinned; };

function hoverText(i) {
  const d = designs[i];
  const values = report.objectives.map((o, k) => `${escaped(o.label)} <b>${number(d.f[k])}</b> ${escaped(o.unit)} ${percent(change(d, k))}`);
  const theta = report.variables.map((v, k) => `${escaped(v.label.toLowerCase())} ${plain(d.x[k])} ${escaped(v.unit)}`).join(', ');
  return `<b>${name(d)}</b>  ${escaped(roles(d).join(', ') || STATUS[d.status])}<br>${values.join('<br>')}<br>${theta}`;
}

function markers(indices, marker, label) {
  return {
    type: 'scatter', mode: 'markers', name: label, marker, customdata: indices, text: indices.map(hoverText), hovertemplate: '%{text}<extra></extra>',
    x: indices.map(i => designs[i].f[front.x]), y: indices.map(i => designs[i].f[front.y]),
  };
}

function frontTraces() {
  const z = third(), [infeasible, behind] = dots([front.x, front.y].map(k => report.objectives[k].view)), best = points(d => d.front && d.status === FEASIBLE);
  const scale = known(z) ? {
    color: best.map(i => designs[i].f[z]), colorscale: 'Viridis', reversescale: false, showscale: true,
    colorbar: {title: {text: report.objectives[z].title, side: 'right', font: font()}, thickness: 10, outlinewidth: 0, len: 0.8, tickfont: font(), ticklen: 0},
  } : {color: color('accent')};
  const traces = [
    markers(infeasible, {symbol: 'x-thin', size: 6, line: {width: 1.2, color: color('lost')}}, 'infeasible'),
    markers(behind, {size: 6, color: color('dot'), opacity: 0.75}, 'feasible, or not computed'),
    markers(best, {size: 10, symbol: best.map(i => designs[i].barred ? 'circle-open' : 'circle'), line: {width: 1, color: color('bg')}, ...scale}, 'best compromise'),
  ];
  const at = points(d => d === original);
  traces.push(markers(at, {symbol: 'diamond', size: 13, color: color('original'), line: {width: 1.5, color: color('bg')}}, 'original'));
  const build = points(d => designs[report.recommended] === d);
  traces.push(markers(build, {symbol: 'star', size: 17, color: color('ink'), line: {width: 1.5, color: color('bg')}}, 'recommended'));
  traces.push({...markers(points(d => designs[state.selected] === d), {symbol: 'circle-open', size: 22, color: color('accent'), line: {width: 2.5}}, 'selected'), hoverinfo: 'skip', hovertemplate: null});
  traces.push({...markers([], {symbol: 'circle-open', size: 18, color: color('ink'), line: {width: 1.5}}, 'hover'), hoverinfo: 'skip', hovertemplate: null});
  return traces.concat(report.compared.map(comparedTrace));
}

/** The front of another run: can be read, not selected. */
function comparedTrace(run, k) {
  const tint = color(COMPARED[k % COMPARED.length]);
  const values = row => report.objectives.map((o, j) => `${escaped(o.label)} <b>${number(row[j])}</b> ${escaped(o.unit)}`).join('<br>');
  return {
    type: 'scatter', mode: 'markers', name: escaped(run.name), marker: {symbol: 'triangle-up', size: 9, color: tint, line: {width: 1, color: color('bg')}},
    x: run.f.map(row => row[front.x]), y: run.f.map(row => row[front.y]),
    text: run.f.map((row, i) => `<b>Design ${run.ids[i]}</b> of ${escaped(run.name)}<br>${values(row)}`), hovertemplate: '%{text}<extra></extra>',
  };
}

function drawFront() {
  const plot = element('front');
  if (!plot) return;
  const [x, y] = [report.objectives[front.x], report.objectives[front.y]];
  plotly().react(plot, frontTraces(), layout({
    xaxis: axis(x.title, {range: x.view}), yaxis: axis(y.title, {range: y.view}), hovermode: 'closest', dragmode: 'zoom', hoverdistance: 24,
  }), {...settings, doubleClick: 'reset+autosize'});
  const inside = ([low, high], value) => value >= low && value <= high;
  const away = points(() => true).filter(i => !inside(x.view, designs[i].f[front.x]) || !inside(y.view, designs[i].f[front.y])).length;
  element('front-outside').textContent = away ? `${away} ${away === 1 ? 'design lies' : 'designs lie'} outside of this view; double-click the chart to see all.` : '';
  sayThinned();
  if (!front.ready) {
    front.ready = true;
    plot.on('plotly_relayout', change => { if (Object.keys(change).some(key => /^[xy]axis/.test(key))) drawDots(); });
    plot.on('plotly_click', event => { const i = event.points[0].customdata; if (known(i)) select(i, {scroll: true}); });
    plot.on('plotly_hover', event => { const i = event.points[0].customdata; if (known(i)) hover(i, 'front'); });
    plot.on('plotly_unhover', () => hover(null, 'front'));
  }
}

/** Moves a ring (trace 5: selected, 6: hovered) to a design. */
function ring(trace, i) {
  const plot = element('front');
  if (!plot || !front.ready) return;
  const shown = known(i) && known(designs[i].f[front.x]) && known(designs[i].f[front.y]);
  plotly().restyle(plot, {x: [shown ? [designs[i].f[front.x]] : []], y: [shown ? [designs[i].f[front.y]] : []]}, [trace]);
}

function frontControls() {
  for (const [id, which] of [['axis-x', 'x'], ['axis-y', 'y']]) {
    const choice = element(id);
    if (!choice) continue;
    choice.value = front[which];
    choice.addEventListener('change', () => {
      const other = which === 'x' ? 'y' : 'x', chosen = Number(choice.value);
      if (front[other] === chosen) front[other] = front[which];
      front[which] = chosen;
      element('axis-x').value = front.x;
      element('axis-y').value = front.y;
      drawFront();
    });
  }
}
