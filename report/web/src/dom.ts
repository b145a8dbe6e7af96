/** Short ways to make and fill elements. */

type Child = Node | string | null | undefined;
type Attributes = Record<
  string,
  string | number | boolean | ((event: Event) => void) | null | undefined
>;

/** An element; attributes that begin with "on" are listeners. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) {
      continue;
    }
    if (typeof value === "function") {
      element.addEventListener(name.slice(2), value);
    } else {
      element.setAttribute(name, value === true ? "" : String(value));
    }
  }
  for (const child of children) {
    if (child !== null && child !== undefined) {
      element.append(child);
    }
  }
  return element;
}

export interface Column {
  head: string;
  /** Numbers stand flush right. */
  numeric?: boolean;
}

/** A table with a caption for screen readers and sight alike. */
export function table(
  caption: string,
  columns: Column[],
  rows: Child[][],
): HTMLElement {
  const head = h("tr");
  for (const column of columns) {
    head.append(
      h("th", { scope: "col", class: column.numeric ? "num" : "" }, column.head),
    );
  }
  const body = h("tbody");
  for (const row of rows) {
    const line = h("tr");
    row.forEach((cell, k) => {
      const numeric = columns[k]?.numeric ? "num" : "";
      line.append(
        k === 0
          ? h("th", { scope: "row", class: numeric }, cell)
          : h("td", { class: numeric }, cell),
      );
    });
    body.append(line);
  }
  return h(
    "div",
    { class: "scroll", tabindex: 0, role: "region", "aria-label": caption },
    h("table", {}, h("caption", {}, caption), h("thead", {}, head), body),
  );
}

/** A part of the page with a heading that the menu can lead to. */
export function section(
  id: string,
  title: string,
  ...children: Child[]
): HTMLElement {
  return h(
    "section",
    { id, "aria-labelledby": `${id}-title` },
    h("h2", { id: `${id}-title` }, title),
    ...children,
  );
}
