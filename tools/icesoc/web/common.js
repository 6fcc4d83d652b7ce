// SPDX-License-Identifier: MIT
//
// common: makes elements for the scripts of the three pages.
"use strict";
function element(tag, text, className) {
  const e = document.createElement(tag);
  if (text !== undefined) e.textContent = text;
  if (className) e.className = className;
  return e;
}
function shape(tag, attributes, text) { // makes an element of an SVG drawing
  const e = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, value);
  if (text !== undefined) e.textContent = text;
  return e;
}
