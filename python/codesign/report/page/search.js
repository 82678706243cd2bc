/** Hypervolume by evaluation, relative to this run's end. */
function drawProgress() {
  const plot = element('progress');
  if (!plot) return;
  const steps = report.progress;
  plotly().react(plot, [{
    type: 'scatter', mode: 'lines', x: steps.count, y: steps.volume, line: {color: color('accent'), width: 2, shape: 'hv'},
    hovertemplate: 'after %{x} designs: %{y:.1%}<extra></extra>',
  }], layout({xaxis: axis('Designs evaluated', {rangemode: 'tozero'}), yaxis: axis('Volume, of this run’s end', {tickformat: '.0%', range: [0, 1.04]}), hovermode: 'x'}), settings);
}

/** Change of each objective from the original: disturbed flights as dots, calm ones as diamonds, one column per design. */
function drawValidation() {
  const plot = element('validation-chart'), strips = report.validation;
  if (!plot || !strips) return;
  const traces = [], axes = {};
  const wobble = n => 0.34 * ((n * 0.618034) % 1) - 0.17;
  const mark = (points, o, marker, label) => ({
    type: 'scatter', mode: 'markers', name: label, marker, xaxis: `x${o + 1}`, yaxis: `y${o + 1}`, showlegend: o === 0,
    x: points.map((p, n) => p.role + (marker.symbol ? 0 : wobble(n))), y: points.map(p => p.change), text: points.map(p => escaped(p.flight)),
    hovertemplate: '%{text}: %{y:+.1%}<extra></extra>',
  });
  strips.objectives.forEach((objective, o) => {
    traces.push(mark(objective.disturbed, o, {size: 5, color: color('series-1'), opacity: 0.55}, 'disturbed flight'));
    traces.push(mark(objective.calm, o, {size: 8, symbol: 'diamond', color: color('ink'), line: {width: 1, color: color('bg')}}, 'calm flight'));
    const width = 1 / strips.objectives.length, names = strips.roles.map(r => escaped(r).replace(' ', '<br>'));
    axes[`xaxis${o + 1}`] = axis('', {domain: [o * width + 0.03, (o + 1) * width - 0.02], anchor: `y${o + 1}`, tickvals: names.map((n, k) => k), ticktext: names, range: [-0.6, names.length - 0.4], showgrid: false, tickangle: 0});
    axes[`yaxis${o + 1}`] = axis('', {anchor: `x${o + 1}`, tickformat: '+.1~%', zeroline: true, zerolinecolor: color('original'), zerolinewidth: 1.5});
  });
  const annotations = strips.objectives.map((objective, o) => ({
    text: `<b>${escaped(objective.label)}</b>`, x: o / strips.objectives.length + 0.03, y: 1.02, xref: 'paper', yref: 'paper', xanchor: 'left', yanchor: 'bottom', showarrow: false, font: {...font(), color: color('ink')},
  }));
  plotly().react(plot, traces, layout({...axes, annotations, margin: {l: 30, r: 8, t: 34, b: 60}, showlegend: true, hovermode: 'closest', legend: {orientation: 'h', x: 1, xanchor: 'right', y: 1.02, yanchor: 'bottom', font: font(), bgcolor: 'rgba(0,0,0,0)'}}), settings);
}
