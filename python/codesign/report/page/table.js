/** The table of designs: filter, sort, select by mouse or keyboard. */
const table = {filter: 'front', key: null, descending: false, rows: [], height: 0, drawn: [0, 0]};
const WHOLE = 400;  // rows that are drawn at once; of more, those in view and AROUND of them before and after
const AROUND = 60;
const PRINTED = 2000;  // rows that go on paper
const FILTERS = {
  front: d => d.front, feasible: d => d.status === FEASIBLE, all: () => true, rejected: d => d.status !== FEASIBLE,
};

const remark = d => [...roles(d), ...(d.status === FEASIBLE ? d.against : [d.reason || STATUS[d.status]])].join(', ') || STATUS[d.status];

function columns() {
  const found = [{head: 'Design', value: d => d.id ?? -1, text: d => d.id === null ? 'original' : d.id}];
  report.variables.forEach((v, k) => found.push({head: v.label, unit: v.unit, text_align: Boolean(v.names), value: d => d.x[k], text: d => plain(d.x[k])}));
  report.objectives.forEach((o, k) => found.push({
    head: o.label, unit: o.unit, value: d => d.f[k],
    text: d => known(d.f[k]) ? number(d.f[k]) + (original ? `<small>${percent(change(d, k))}</small>` : '') : lacking(d),
  }));
  report.constraints.forEach((c, k) => found.push({head: c.label, unit: [c.unit, c.rule].filter(Boolean).join(' '), value: d => d.c[k], text: d => known(d.c[k]) ? `<span class="${below(c, d.c[k]) ? 'bad' : ''}">${number(d.c[k], 3)}</span>` : lacking(d)}));
  found.push({head: 'Remark', text_align: true, value: remark, text: d => escaped(remark(d))});
  return found;
}
const shownColumns = columns();

function compare(a, b) {
  const missing = v => !known(v) || v === '';
  if (missing(a) || missing(b)) return missing(a) - missing(b);
  const order = typeof a === 'string' ? a.localeCompare(b) : a - b;
  return table.descending ? -order : order;
}

function drawTable() {
  const head = element('designs-head'), body = element('designs-body');
  if (!body) return;
  head.innerHTML = '<tr>' + shownColumns.map((c, k) => {
    const sort = table.key === k ? (table.descending ? 'descending' : 'ascending') : 'none';
    return `<th scope="col" class="${c.text_align ? 'text' : ''}" aria-sort="${sort}"><button type="button" data-column="${k}"><span>${escaped(c.head)}</span><small>${escaped(c.unit || '') || '&nbsp;'}</small></button></th>`;
  }).join('') + '</tr>';
  const rows = designs.map((d, i) => i).filter(i => FILTERS[table.filter](designs[i]));
  if (table.key !== null) {
    const values = designs.map(shownColumns[table.key].value);
    rows.sort((i, j) => compare(values[i], values[j]));
  }
  table.rows = rows;
  drawRows();
  document.querySelectorAll('[data-filter]').forEach(b => b.setAttribute('aria-pressed', b.dataset.filter === table.filter));
  hintSideways();
}

/** The rows that are in view, or all of a short table; spaces stand for the others, so that the bar at the side is right. */
function drawRows() {
  const body = element('designs-body'), box = element('designs-scroll'), count = table.rows.length;
  const printing = document.documentElement.classList.contains('printing');
  const top = table.height ? Math.min(Math.floor(box.scrollTop / table.height), count - 1) : 0;
  const seen = table.height ? Math.ceil(box.clientHeight / table.height) : AROUND;
  const [first, end] = printing ? [0, Math.min(count, PRINTED)] : count <= WHOLE ? [0, count] : [Math.max(0, top - AROUND), Math.min(count, top + seen + AROUND)];
  const focused = body.contains(document.activeElement) ? document.activeElement.dataset.design : null;
  const space = rows => rows && !printing ? `<tr class="space" aria-hidden="true"><td colspan="${shownColumns.length}" style="height:${rows * table.height}px"></td></tr>` : '';
  const rows = table.rows.slice(first, end).map((i, k) => `<tr tabindex="-1" data-design="${i}" aria-selected="false" aria-rowindex="${first + k + 2}">` +
    shownColumns.map(c => `<td class="${c.text_align ? 'text' : ''}">${c.text(designs[i])}</td>`).join('') + '</tr>').join('');
  body.innerHTML = count ? space(first) + rows + space(count - end) : `<tr><td class="text" colspan="${shownColumns.length}">No such design in this run.</td></tr>`;
  body.closest('table').setAttribute('aria-rowcount', count + 1);
  table.drawn = [first, end];
  if (!table.height && end < count && !printing) {
    table.height = body.firstElementChild.getBoundingClientRect().height;
    body.insertAdjacentHTML('beforeend', space(count - end));
  }
  if (end - first < count && !printing) element('designs-head').querySelectorAll('th').forEach(th => { th.style.minWidth = `${th.offsetWidth}px`; });
  element('designs-count').textContent = `${count} of ${designs.length} designs` + (printing && end < count ? `, the first ${end} of them here` : '');
  markRow();
  if (focused !== null) rowOf(focused)?.focus({preventScroll: true});
}

/** Draws the rows that have come into view. */
function followScroll() {
  const box = element('designs-scroll'), top = box.scrollTop / (table.height || 1);
  const [first, end] = table.drawn, last = top + box.clientHeight / (table.height || 1);
  if (end - first < table.rows.length && (top < first || last > end)) drawRows();
}

const rowOf = i => element('designs-body')?.querySelector(`tr[data-design="${i}"]`);

function markRow() {
  const body = element('designs-body');
  if (!body) return;
  body.querySelectorAll('tr[aria-selected="true"]').forEach(r => { r.setAttribute('aria-selected', 'false'); r.tabIndex = -1; });
  const row = rowOf(state.selected);
  if (row) { row.setAttribute('aria-selected', 'true'); row.tabIndex = 0; }
  else { const first = body.querySelector('tr[data-design]'); if (first) first.tabIndex = 0; }
}

/** All designs with every column of the table, as comma-separated values. */
function csv() {
  const cell = value => /[",\n]/.test(value) ? `"${String(value).replace(/"/g, '""')}"` : String(value ?? '');
  const head = c => [c.head, c.unit && `(${c.unit})`].filter(Boolean).join(' ');
  const rows = designs.map(d => [STATUS[d.status], ...shownColumns.map(c => c.value(d))]);
  return [['Status', ...shownColumns.map(head)], ...rows].map(row => row.map(cell).join(',')).join('\r\n') + '\r\n';
}

/** Says that a table continues to the side, where it does. */
function hintSideways() {
  const box = element('designs-scroll');
  if (box) element('designs-sideways').hidden = box.scrollWidth <= box.clientWidth;
}

/** Scrolls the table, not the page, to the selected row. */
function revealRow() {
  const box = element('designs-scroll'), at = table.rows.indexOf(state.selected);
  if (!box || at < 0) return;
  if (!rowOf(state.selected)) { box.scrollTop = at * table.height - box.clientHeight / 2; drawRows(); }
  box.scrollTop = rowOf(state.selected).offsetTop - box.clientHeight / 2;
}

function tableControls() {
  const body = element('designs-body');
  if (!body) return;
  document.querySelectorAll('[data-filter]').forEach(b => b.addEventListener('click', () => { table.filter = b.dataset.filter; drawTable(); }));
  element('designs-head').addEventListener('click', event => {
    const button = event.target.closest('[data-column]');
    if (!button) return;
    const key = Number(button.dataset.column);
    table.descending = table.key === key ? !table.descending : false;
    table.key = key;
    drawTable();
    element('designs-head').querySelector(`[data-column="${key}"]`).focus();
  });
  const target = event => { const row = event.target.closest('tr[data-design]'); return row ? Number(row.dataset.design) : null; };
  body.addEventListener('click', event => { const i = target(event); if (known(i)) select(i); });
  body.addEventListener('mouseover', event => hover(target(event), 'table'));
  body.addEventListener('mouseleave', () => hover(null, 'table'));
  body.addEventListener('keydown', event => {
    const i = target(event), at = table.rows.indexOf(i);
    const next = table.rows[{ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: table.rows.length - 1}[event.key]];
    if (event.key === 'Enter' || event.key === ' ') { event.preventDefault(); select(i); }
    else if (known(next)) { event.preventDefault(); select(next); rowOf(next).focus({preventScroll: true}); }
  });
  let asked = false;
  element('designs-scroll').addEventListener('scroll', () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => { asked = false; followScroll(); });
  });
}
