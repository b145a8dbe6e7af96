import type { PageData } from "./data";
import { h } from "./dom";
export function showPage(root: HTMLElement, data: PageData): void {
  root.append(h("h1", {}, data.result?.case ?? "Meniscus"));
}
