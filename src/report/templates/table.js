"use strict";
// A table that sorts by its headings, searches every cell and shows a page at a time.
function dataTable(root, table, rowsAPage) {
  const printedRows = 300;
  let rowsShown = rowsAPage;
  const state = {column: 0, down: false, text: "", page: 0};
  const make = (tag, parent, content) => {
    const element = document.createElement(tag);
    if (content !== undefined) element.textContent = content;
    parent.append(element);
    return element;
  };
  const controls = make("div", root);
  controls.className = "controls";
  const search = make("input", controls);
  search.type = "search";
  search.placeholder = "Search";
  search.setAttribute("aria-label", "Search the table");
  const back = make("button", controls, "Back"), on = make("button", controls, "On"), where = make("span", controls);
  const scroll = make("div", root);
  scroll.className = "scroll";
  const shown = make("table", scroll), head = make("tr", make("thead", shown)), body = make("tbody", shown);
  const headings = table.heads.map((column, index) => {
    const cell = make("th", head);
    cell.className = "sorts";
    const button = make("button", cell);
    button.addEventListener("click", () => {
      state.down = state.column === index ? !state.down : false;
      state.column = index;
      state.page = 0;
      draw();
    });
    return {cell, button, name: column.name};
  });
  const before = (a, b) => {
    const number = table.heads[state.column].number;
    const p = a[state.column], q = b[state.column];
    if (p === null || q === null) return (p === null) - (q === null);  // what is not there comes last, always
    const order = number ? p - q : String(p.text ?? p).localeCompare(String(q.text ?? q), "en", {numeric: true});
    return state.down ? -order : order;
  };
  const fill = (cell, value, number) => {
    if (value === null) return;
    if (number) cell.className = "number";
    if (typeof value !== "object") {
      cell.textContent = value;
      if (String(value).length > 40) cell.className = "wide";
      return;
    }
    const place = value.link ? make("a", cell) : cell;
    if (value.link) place.href = value.link;
    if (value.picture) {
      const picture = make("img", place);
      picture.className = "thumbnail";
      picture.src = value.picture;
      picture.alt = value.text;
    } else {
      place.append(value.text);
    }
  };
  function draw() {
    const wanted = state.text.toLowerCase();
    const rows = table.rows.filter(r => wanted === "" ||
        r.some(v => v !== null && String(v.text ?? v).toLowerCase().includes(wanted))).sort(before);
    const pages = Math.max(1, Math.ceil(rows.length / rowsShown));
    state.page = Math.min(state.page, pages - 1);
    const first = state.page * rowsShown, part = rows.slice(first, first + rowsShown);
    body.replaceChildren();
    for (const row of part) {
      const line = make("tr", body);
      row.forEach((value, index) => fill(make("td", line), value, table.heads[index].number));
    }
    headings.forEach((h, index) => {
      h.button.textContent = h.name + (index !== state.column ? "" : state.down ? " ↓" : " ↑");
      h.cell.setAttribute("aria-sort", index !== state.column ? "none" : state.down ? "descending" : "ascending");
    });
    where.textContent = rows.length === 0 ? "nothing found"
        : `${first + 1} to ${first + part.length} of ${rows.length}`;
    back.disabled = state.page === 0;
    on.disabled = state.page === pages - 1;
  }
  search.addEventListener("input", () => { state.text = search.value; state.page = 0; draw(); });
  back.addEventListener("click", () => { --state.page; draw(); });
  on.addEventListener("click", () => { ++state.page; draw(); });
  const show = rows => { rowsShown = rows; state.page = 0; draw(); };
  window.addEventListener("beforeprint", () => show(printedRows));
  window.addEventListener("afterprint", () => show(rowsAPage));
  draw();
}
