// The tooltip: one for the page.

const tip = make("div", { class: "tip", role: "status", "aria-live": "polite" });

/** Fields between bars; `\|` is a bar within a field and `\\` a backslash. */
const fields = (text) => {
  const found = [""];
  for (let at = 0; at < text.length; at += 1) {
    const [here, next] = [text[at], text[at + 1]];
    if (here === "|") found.push("");
    else if (here === "\\" && (next === "|" || next === "\\")) found[found.length - 1] += text[(at += 1)];
    else found[found.length - 1] += here;
  }
  return found;
};

/** The lines of an element with `data-t`: pairs of a name and a value. */
const linesOf = (element) => {
  const named = element.closest("[data-names]");
  const names = named ? fields(named.dataset.names) : [];
  return fields(element.dataset.t).map((value, index) => [names[index] || "", value]).filter(([name, value]) => name || value);
};

const hideTip = () => {
  tip.classList.remove("shown");
  tip.replaceChildren();
};

/** Shows `lines` beside a place of the window, and never past its edges. */
const showTip = (lines, x, y) => {
  tip.replaceChildren(...lines.map(([name, value]) => make("div", {}, make("span", {}, name ? `${name} ` : ""), make("b", {}, value))));
  tip.classList.add("shown");
  const { width, height } = tip.getBoundingClientRect();
  const room = document.documentElement;
  const left = x + 14 + width > room.clientWidth ? x - 14 - width : x + 14;
  const top = y + 14 + height > room.clientHeight ? y - 14 - height : y + 14;
  tip.style.left = `${within(left, 4, Math.max(4, room.clientWidth - width - 4))}px`;
  tip.style.top = `${within(top, 4, Math.max(4, room.clientHeight - height - 4))}px`;
};
