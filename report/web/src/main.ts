import "./style.css";
import { pageData } from "./data";
import { h } from "./dom";
import { showPage } from "./page";

const root = document.getElementById("page")!;
const data = pageData();
root.replaceChildren();
if (data === null) {
  root.append(h("p", {}, "This page holds no results."));
} else {
  showPage(root, data);
}
