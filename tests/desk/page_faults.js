// What a screen reader or a keyboard would miss on a page.
() => {
  const seen = [...document.querySelectorAll("*")].filter((node) => node.checkVisibility?.({ visibilityProperty: true }));
  const words = (node) => node.getAttribute("aria-label") || node.title || node.placeholder || node.textContent.trim()
    || [...(node.labels ?? [])].map((one) => one.textContent.trim()).join("")
    || (node.getAttribute("aria-labelledby") ?? "").split(" ").map((id) => document.getElementById(id)?.textContent).join("");
  const said = (node) => node.outerHTML.slice(0, 90);
  const faults = [];
  for (const node of seen.filter((one) => one.matches("button, a, input, select, summary, progress, dialog, aside")))
    if (!words(node)) faults.push(`no name: ${said(node)}`);
  for (const node of seen.filter((one) => one.matches("svg, img")))
    if (!node.getAttribute("alt") && !node.closest("[aria-hidden=true]") && !(node.getAttribute("role") === "img" && node.getAttribute("aria-label")))
      faults.push(`drawing without words: ${said(node)}`);
  const ids = [...document.querySelectorAll("[id]")].map((node) => node.id);
  ids.filter((id, i) => ids.indexOf(id) < i).forEach((id) => faults.push(`id twice: ${id}`));
  for (const name of ["for", "aria-labelledby", "aria-describedby"])
    for (const node of document.querySelectorAll(`[${name}]`))
      for (const id of node.getAttribute(name).split(" ")) if (!ids.includes(id)) faults.push(`${name} of nothing: ${said(node)}`);
  const levels = seen.filter((one) => one.matches("h1, h2, h3, h4")).map((one) => +one.tagName[1]);
  if (levels.filter((one) => one === 1).length !== 1 || levels[0] !== 1) faults.push(`headings: ${levels}`);
  if (levels.some((one, i) => i && one > levels[i - 1] + 1)) faults.push(`heading left out: ${levels}`);
  if (document.querySelectorAll("main").length !== 1) faults.push("not one main part");
  for (const node of document.querySelectorAll(":is(div, span, p, pre, code)[aria-label]:not([role])")) faults.push(`name without a role: ${said(node)}`);
  if (!document.documentElement.lang || !document.title) faults.push("no language or title");
  for (const node of seen.filter((one) => one.scrollWidth > one.clientWidth + 1 && getComputedStyle(one).overflowX === "auto"))
    if (node.tabIndex < 0 && !node.querySelector("a, button, input, select, [tabindex]")) faults.push(`scrolled by no key: ${said(node)}`);
  for (const node of seen.filter((one) => one.matches("table")))
    if (!node.caption || !node.querySelector("th[scope]")) faults.push(`table without caption or heads: ${said(node)}`);
  return faults;
}
