// The table of nodes, and the details of the one that is selected.

import { factsOf, factsOfAll, showFacts } from './details.js';
import { NOTHING, count, number, percent, sum } from './format.js';
import { lostAfter } from './model.js';

function levelOf(value, fair, bad) {
  if (value === undefined || value === null) return '';
  if (value >= bad) return 'bad';
  return value >= fair ? 'fair' : '';
}

/** Texts and levels of a node's cells after its name. */
function cellsOf(node, source) {
  const { telemetry, radio } = node;
  const pose = source === 'truth' || !node.vehicle ? node.truth : telemetry;
  return [
    [number(pose?.p_m[2], 1)],
    [node.vehicle ? number(pose?.speed_mps, 2) : NOTHING],
    [number(telemetry?.age_s, 2), levelOf(telemetry?.age_s, lostAfter(node) / 2, lostAfter(node))],
    [percent(telemetry?.loss), levelOf(telemetry?.loss, 0.05, 0.25)],
    [count(radio?.transmissions)],
    [count(radio?.received)],
    [radio ? count(sum(radio.lost)) : NOTHING],
  ];
}

export class FleetTable {
  /** @param onSelect called with a node's number, or null */
  constructor(table, details, onSelect) {
    this.body = table.tBodies[0];
    this.details = details;
    this.onSelect = onSelect;
    this.rows = new Map();
    this.selected = null;
  }

  #row(node) {
    const row = this.body.insertRow();
    row.dataset.node = node.node;
    row.dataset.vehicle = node.vehicle;
    const head = document.createElement('th');
    head.scope = 'row';
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = node.name;
    head.append(button);
    row.append(head);
    const state = document.createElement('span');
    state.className = 'state';
    row.insertCell().append(state);
    const cells = cellsOf(node, 'truth').map(() => {
      const cell = row.insertCell();
      cell.className = 'n';
      return cell;
    });
    row.addEventListener('click', () => this.onSelect(this.selected === node.node ? null : node.node));
    return { row, state, cells };
  }

  /** Shows `snapshot`; altitude and speed come from `source`. */
  show(snapshot, source) {
    const fleet = JSON.stringify(snapshot.nodes.map((node) => [node.node, node.name, node.vehicle]));
    if (fleet !== this.fleet) {  // another run on the same port, say
      this.fleet = fleet;
      this.body.replaceChildren();
      const fixedLast = [...snapshot.nodes].sort((a, b) => b.vehicle - a.vehicle);
      this.rows = new Map(fixedLast.map((node) => [node.node, this.#row(node)]));
    }
    for (const node of snapshot.nodes) {
      const { row, state, cells } = this.rows.get(node.node);
      const word = node.vehicle ? node.telemetry?.state ?? 'not heard' : 'fixed';
      if (state.textContent !== word) {
        state.textContent = word;
        state.dataset.state = word;
      }
      cellsOf(node, source).forEach(([text, level = ''], i) => {
        if (cells[i].textContent !== text) cells[i].textContent = text;
        if (cells[i].dataset.level !== level) cells[i].dataset.level = level;
      });
      row.setAttribute('aria-selected', String(node.node === this.selected));
    }
    this.#showDetails(snapshot);
  }

  select(node) {
    this.selected = node;
  }

  #showDetails(snapshot) {
    const node = snapshot.nodes.find((candidate) => candidate.node === this.selected);
    showFacts(this.details, node ? node.name : 'Whole fleet', node ? factsOf(node, snapshot) : factsOfAll(snapshot));
  }
}
