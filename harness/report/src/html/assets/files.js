// Files that the reader takes along.

const csv = (rows) => rows.map((row) => `${row.map(csvCell).join(",")}\r\n`).join("");

const SVG = "http://www.w3.org/2000/svg";

// Those that children take over from their parent, and those that they do not, with what they are unless set.
const INHERITED = ["fill", "stroke", "stroke-width", "stroke-dasharray", "stroke-linecap", "stroke-linejoin", "fill-opacity", "stroke-opacity",
  "font-family", "font-size", "font-weight", "font-style", "text-anchor"];
const OWN = [["opacity", "1"], ["vector-effect", "none"], ["dominant-baseline", "auto"], ["image-rendering", "auto"]];

/** Writes onto `copy` how `node` looks, and drops what does not show. */
const inlineStyle = (node, copy, above) => {
  const style = getComputedStyle(node);
  // Places that only answer are nothing to see.
  if (style.display === "none" || node.matches(".point")) {
    copy.remove();
    return;
  }
  const children = [...copy.children];
  for (const name of INHERITED) {
    const value = style.getPropertyValue(name);
    if (!above || value !== above.getPropertyValue(name)) copy.setAttribute(name, value);
    else copy.removeAttribute(name);
  }
  for (const [name, unless] of OWN) {
    const value = style.getPropertyValue(name);
    if (value !== unless) copy.setAttribute(name, value);
  }
  for (const { name } of [...copy.attributes]) if (/^(data-|aria-|class$|style$|tabindex$|role$)/.test(name)) copy.removeAttribute(name);
  [...node.children].forEach((child, index) => inlineStyle(child, children[index], style));
};

/** What an SVG element shows, as a file of its own in the light colours. */
const standalone = (svg) => {
  const root = document.documentElement;
  const theme = root.getAttribute("data-theme");
  root.setAttribute("data-theme", "light");
  const copy = svg.cloneNode(true);
  inlineStyle(svg, copy, null);
  if (theme === null) root.removeAttribute("data-theme");
  else root.setAttribute("data-theme", theme);
  const [left, top, width, height] = numbers(svg.getAttribute("viewBox"), 4) || [0, 0, svg.clientWidth, svg.clientHeight];
  const paper = document.createElementNS(SVG, "rect");
  for (const [name, value] of Object.entries({ x: left, y: top, width, height, fill: "#ffffff", stroke: "none" })) paper.setAttribute(name, value);
  copy.prepend(paper);
  copy.setAttribute("xmlns", SVG);
  copy.setAttribute("width", width);
  copy.setAttribute("height", height);
  return `<?xml version="1.0" encoding="UTF-8"?>\n${new XMLSerializer().serializeToString(copy)}\n`;
};
