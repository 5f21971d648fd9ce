// How the search of the documentation's pages orders what it finds: pages of modules and of
// all keys, and the list of changes, come behind texts.
var Scorer = {
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
  score: ([docname, title, anchor, descr, score]) =>
    /^(CHANGELOG$|reference\/(?!commands$))/.test(docname) ? score - 1000 : score,
};
