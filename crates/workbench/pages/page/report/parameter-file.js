// The parameter file, and what other files of the page share with it.

/** A value as a parameter file has it. */
export function written({ kind, items }, value) {
  if (kind === "enumeration") return `"${items[value - 1]}"`;
  if (kind === "boolean") return String(value !== 0);
  const text = String(value);
  return kind === "real" && /^-?\d+$/.test(text) ? `${text}.0` : text;
}

/** A text as a comment or a name may have it. */
export const asComment = (text) => text.replace(/[\u0000-\u001f\u007f]/g, " ");

/** Text of the parameter file: what differs from the rig with default parameters. */
export function parameterFile({ parameters, heading }, values) {
  const lines = parameters.flatMap((parameter, slot) => {
    if (values[slot] === parameter.base) return [];
    const unit = parameter.unit ? ` [${parameter.unit}]` : "";
    return [`\n# ${parameter.text}${unit}\n"${parameter.name}" = ${written(parameter, values[slot])}\n`];
  });
  return `# ${asComment(heading)}\n${lines.join("")}`;
}
