// Building the document. Text is always text: nothing that a user has named can become markup.

/** Sets attributes, and `style` by the object model: the page's policy forbids it as an attribute. */
export function setAttributes(made, { style = "", ...attributes }) {
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  if (style) made.style.cssText = style;
  return made;
}

/** A new element with attributes and children (elements, or strings). */
export function element(tag, attributes = {}, children = []) {
  const made = setAttributes(document.createElement(tag), attributes);
  made.append(...children);
  return made;
}

/** Gives a text of a media type to save as a file. */
export function saveAs(name, text, type) {
  const link = element("a", { download: name });
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

export const byId = (id) => document.getElementById(id);

/** Clears a canvas and makes it as fine as the screen; returns its context and its size in CSS pixels. */
export function fitted(canvas) {
  const { width, height } = canvas.getBoundingClientRect();
  const ratio = window.devicePixelRatio || 1;
  const size = { width: Math.max(1, Math.round(width * ratio)), height: Math.max(1, Math.round(height * ratio)) };
  const context = canvas.getContext("2d");
  // Another size makes a new picture, which is slow.
  if (canvas.width !== size.width || canvas.height !== size.height) Object.assign(canvas, size);
  else context.reset();
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.font = "11px system-ui, sans-serif";
  return { context, width, height };
}

/** Draws a straight line. */
export function drawSegment(context, from, to, paint, width) {
  context.strokeStyle = paint;
  context.lineWidth = width;
  context.beginPath();
  context.moveTo(...from);
  context.lineTo(...to);
  context.stroke();
}
