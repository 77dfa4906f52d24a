// Weights of the search: pages that explain come before tables, and these before records of work.
var Scorer = {
  score: ([page, title, , , score, , kind]) => {
    // A page whose heading is what was typed comes first.
    const typed = new URLSearchParams(location.search).get("q")?.trim().toLowerCase();
    if (title.replace("*", "").toLowerCase() === typed) return score + 20;
    const weights = [
      [/^generated\/changelog$|^audits$|^design$|^generated\/contributing$|^robustness$/, -12],
      [/^generated\/(keywords|elements)\//, kind === "title" ? 0 : -4],
      [/^generated\/(reference|gallery)\/|^verification\//, -2],
      [/^generated\//, -2],
      [/^howto\//, 5],
    ];
    const found = weights.find(([pattern]) => pattern.test(page));
    return score + (found ? found[1] : 4);
  },
  objNameMatch: 11,
  objPartialMatch: 2,
  objPrio: { 0: 8, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
