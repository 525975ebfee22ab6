// What the pages do by themselves: the search, keys as this system has them, the folded list of pages.
"use strict";

const MOST = 8;  // results
const AROUND = 70;  // letters before and after what was found

const field = document.getElementById("search");
const list = document.getElementById("found");

if (/Mac|iPhone|iPad/.test(navigator.platform)) {
  for (const key of document.querySelectorAll("kbd[data-mac]")) key.textContent = key.dataset.mac;
}

// On a narrow screen the list of pages is folded.
if (matchMedia("(max-width: 52rem)").matches) document.querySelector("details.menu").open = false;

const here = document.querySelector("nav [aria-current]");
if (here && here.offsetTop > innerHeight - 150) document.querySelector("nav").scrollTop = here.offsetTop - 200;

function words(text) {
  return text.toLowerCase().split(/[^\p{L}\p{N}]+/u).filter(Boolean);
}

// How well a part fits what is looked for; 0 where a word is missing.
function score([title, , heading, text], wanted) {
  const names = `${title} ${heading}`.toLowerCase(), body = text.toLowerCase();
  let sum = 0;
  for (const word of wanted) {
    const begins = new RegExp(`(^|[^\\p{L}\\p{N}])${word}`, "u");
    if (begins.test(names)) sum += title === heading ? 30 : 20;
    else if (begins.test(body)) sum += 4;
    else if (body.includes(word)) sum += 1;
    else return 0;
  }
  return sum;
}

function excerpt(text, wanted) {
  const at = Math.max(0, ...wanted.map((word) => text.toLowerCase().indexOf(word)).slice(0, 1));
  const begin = Math.max(0, at - AROUND), end = Math.min(text.length, at + AROUND);
  return (begin ? "…" : "") + text.slice(begin, end) + (end < text.length ? "…" : "");
}

function marked(element, text, wanted) {
  const pattern = new RegExp(`(${wanted.join("|")})`, "gi");
  text.split(pattern).forEach((piece, index) => {
    if (index % 2) element.appendChild(document.createElement("mark")).textContent = piece;
    else element.append(piece);
  });
}

function show() {
  const wanted = words(field.value);
  list.replaceChildren();
  list.hidden = !wanted.length;
  if (!wanted.length) return;
  const found = PARTS.map((part) => [score(part, wanted), part])
    .filter(([points]) => points)
    .sort(([one], [other]) => other - one)
    .slice(0, MOST);
  for (const [, [title, url, heading, text]] of found) {
    const link = document.createElement("a");
    link.href = url;
    marked(link, title === heading ? title : `${title} › ${heading}`, wanted);
    marked(link.appendChild(document.createElement("small")), excerpt(text, wanted), wanted);
    list.appendChild(document.createElement("li")).append(link);
  }
  if (!found.length) list.innerHTML = "<li><p>Nothing was found.</p></li>";
  choose(0);
}

function choose(step) {
  const links = [...list.querySelectorAll("a")];
  const now = links.findIndex((link) => link.classList.contains("chosen"));
  const next = Math.min(Math.max(now + step, 0), links.length - 1);
  links.forEach((link, index) => link.classList.toggle("chosen", index === next));
  if (links[next]) links[next].scrollIntoView({ block: "nearest" });
}

field.addEventListener("input", show);
field.addEventListener("focus", show);
field.addEventListener("keydown", (event) => {
  const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
  if (step) {
    choose(step);
    event.preventDefault();
  } else if (event.key === "Escape") {
    field.value = "";
    show();
  }
});
field.form.addEventListener("submit", (event) => {
  event.preventDefault();
  const link = list.querySelector("a.chosen");
  if (link) {
    list.hidden = true;
    location.href = link.href;
  }
});
document.addEventListener("click", (event) => {
  if (!field.form.contains(event.target)) list.hidden = true;
});
document.addEventListener("keydown", (event) => {
  if (event.key === "/" && document.activeElement !== field) {
    field.focus();
    event.preventDefault();
  }
});
