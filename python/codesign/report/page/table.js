/** The table of designs: filter, sort, select by mouse or keyboard. */
const table = {filter: 'front', key: null, descending: false};
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
  if (table.key !== null) rows.sort((i, j) => compare(shownColumns[table.key].value(designs[i]), shownColumns[table.key].value(designs[j])));
  table.rows = rows;
  body.innerHTML = rows.map(i => `<tr tabindex="-1" data-design="${i}" aria-selected="false">` +
    shownColumns.map(c => `<td class="${c.text_align ? 'text' : ''}">${c.text(designs[i])}</td>`).join('') + '</tr>').join('') ||
    `<tr><td class="text" colspan="${shownColumns.length}">No such design in this run.</td></tr>`;
  element('designs-count').textContent = `${rows.length} of ${designs.length} designs`;
  document.querySelectorAll('[data-filter]').forEach(b => b.setAttribute('aria-pressed', b.dataset.filter === table.filter));
  markRow();
  hintSideways();
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
  const row = rowOf(state.selected), box = element('designs-scroll');
  if (row) box.scrollTop = row.offsetTop - box.clientHeight / 2;
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
    const row = event.target.closest('tr[data-design]');
    const next = {ArrowDown: row?.nextElementSibling, ArrowUp: row?.previousElementSibling, Home: body.firstElementChild, End: body.lastElementChild}[event.key];
    if (event.key === 'Enter' || event.key === ' ') { event.preventDefault(); select(Number(row.dataset.design)); }
    else if (next) { event.preventDefault(); next.focus(); select(Number(next.dataset.design)); }
  });
}
