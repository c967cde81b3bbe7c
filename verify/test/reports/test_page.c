/* SPDX-License-Identifier: GPL-3.0-or-later
 * The report's page, JUnit file and summary: well-formed, self-contained, and the verdict in them
 * is that of the results, also where results are missing, odd or not finite. */
#include "test.h"

#include "findings.h"
#include "markup.h"
#include "page.h"
#include "summary.h"
#include "verdict.h"

static const char *const results_text =
    "{'schema': 'sphproof/1', 'command': 'report', 'mode': 'quick', 'version': '1', 'git': 'abc',"
    "'compiler': 'gcc', 'flags': '-O3', 'date': '2001-02-03', 'machine': {'cores': 2},"
    "'runs': [{'through_time': {'time': [0, 0.1, 0.2], 'momentum': [0, 1e-16, 2e-16], 'energy': [0,"
    " 0, 1e-9], 'regularity': {'time': [0, 0.2], 'spread': [0, 0.1], 'paired': [0, 0]}}, 'case': "
    "'sod', 'title': 'a <b> & c', 'label': 'ia', 'reproduce': 'sphproof run "
    "sod',"
    " 'n': 4, 'status': 'ok', 'errors': {'density': {'l1': 0.00461}}, 'profile': {'x': [0, 1, "
    "2],"
    " 'density': [1, 1, 2], 'velocity': [0, 0, 'nan'], 'pressure': [1, 1, 1], 'exact_density':"
    " [1, 1, 1], 'exact_velocity': [0, 0, 0], 'exact_pressure': [1, 1, 1], 'exact': {'x': [0, 2],"
    " 'density': [1, 1], 'velocity': [0, 0], 'pressure': [1, 1]}}}],"
    "'studies': [{'case': 'sod', 'label': 'ia', 'reproduce': 'sphproof converge sod',"
    " 'levels': [{'n': 100, 'errors': {'density': {'l1': 0.01}}, 'replicates': 9, 'spread':"
    " {'density': {'l1': 0.151}}}, {'n': 200, 'errors': {'density': {'l1': 0.005}},"
    " 'replicates': 9, 'spread': {'density': {'l1': 0.02}}}], 'orders': [{'field': 'density', "
    "'norm': 'l1', 'order': 1.0, 'low': "
    "0.9,"
    " 'high': 1.1, 'pairwise': [1.0], 'gate': {'low': 0.9, 'high': 1.1, 'bound': 0.02},"
    " 'status': 'pass'}], 'functionals': [{'name': 'mean_pressure', 'values': [0.97050, 0.96854,"
    " 0.96178], 'extrapolated': 0.9713003, 'gci': 0.00103083, 'gci_coarse': 0.00356249,"
    " 'order': 1.786170, 'class': 'asymptotic', 'exact': 'nan'}]}],"
    "'kernels': [{'kernel': 'cubic_spline', 'dim': 1, 'class': 2, 'normalisation': 1e-16,"
    " 'fourier': {'min': 0, 'first_negative_k': null}, 'checks': [], 'reproduce': 'x'}],"
    "'bench': [{'case': 'sod', 'title': 'Sod', 'reproduce': 'sphproof bench sod', 'schemes':"
    " [{'scheme': 'kernel=cubic_spline gradient=ia', 'figure_of_merit': 1e-8,"
    " 'seed_plain_over_this': 120}], 'points': [{'scheme': 'kernel=cubic_spline gradient=ia',"
    " 'n': 4, 'error': 0.01, 'cpu_s': 0.001}], 'cheapest': [{'target': 0.01, 'cpu_s': null,"
    " 'scheme': null}]}],"
    "'gradients': {'rows': [{'operator': 'ia', 'dim': 2, 'exact_degree_lattice': 2, "
    "'momentum_defect': 1e-16,"
    " 'error_disordered': 0.3, 'none': null}],"
    " 'reproduce': 'sphproof verify gradients'},"
    "'claims': [{'name': 'ia_shear', 'claim': 'ia < standard', 'verdict': 'holds in 1 of 2', "
    "'without': 'gradient=standard', 'with': 'gradient=ia', 'rows': [{'label': 'viscosity=none', "
    "'figure': 'growth_rate', 'without': 0.125, 'with': 0.0625, 'verdict': 'holds', 'reproduce': "
    "'sphproof run it'}]}],"
    "'verify': {'checks': [{'group': 'kernels', 'name': 'sign', 'subject': 'q < 1 & more',"
    " 'property': 'W >= 0', 'value': 1e-16, 'bound': 1e-15, 'floor': 0, 'status': 'pass',"
    " 'seconds': 0.1}], 'mutants': [{'group': 'kernels', 'check': 'sign', 'mutant': 'minus',"
    " 'value': 1, 'bound': 1e-15, 'detected': true}], 'summary': {'mutants': 1, 'detected': 1}},"
    "'faults': {'git': 'abc', 'date': '2001-02-03', 'faults': [{'fault': 'list | <head', 'part':"
    " 'streams', 'exit': 0, 'status': 'pass', 'detail': '', 'message': 'said so', 'command':"
    " 'faults.py streams'}, {'fault': 'full disk', 'part': 'disk', 'exit': null, 'status': 'skip',"
    " 'detail': '', 'message': 'no disk', 'command': 'faults.py disk'}]},"
    "'score': {'tried': 10, 'generated': 120, 'score': 0.875, 'seconds': 5, 'files': [{'file':"
    " 'src/a.c', 'mutants': 10, 'killed': 7, 'listed': 2, 'survived': 1}], 'survivors': [{'file':"
    " 'src/a.c', 'line': 77, 'change': 'a < b -> <=', 'why': 'no test fails'}]}}";

/* With its verdict. */
static json_t *judged(json_t *results)
{
    json_t *verdict = verdict_make(results);
    assert_non_null(verdict);
    json_object_set_new(results, "verdict", verdict);
    return results;
}

static json_t *sound(void)
{
    char *text = strdup(results_text);
    for (char *c = text; *c; c++)
        if (*c == '\'') *c = '"';
    json_error_t error;
    json_t *results = json_loads(text, 0, &error);
    free(text);
    if (!results) fail_msg("%s at %d", error.text, error.position);
    return judged(results);
}

static json_t *first(const json_t *results, const char *list)
{
    return json_array_get(json_object_get(results, list), 0);
}

/* One fault of every kind. */
static json_t *unsound(void)
{
    json_t *results = sound(), *run = first(results, "runs"), *study = first(results, "studies");
    json_t *verify = json_object_get(results, "verify");
    json_t *faults = json_object_get(results, "faults");
    json_object_set_new(run, "status", json_string("broke_down"));
    json_object_set_new(run, "message", json_string("particle 7 <negative u>"));
    json_object_set_new(first(study, "orders"), "status", json_string("fail"));
    json_object_set_new(first(study, "orders"), "why", json_string("is too low"));
    json_object_set_new(first(verify, "checks"), "status", json_string("fail"));
    json_object_set_new(first(verify, "checks"), "value", json_string("nan"));
    json_object_set_new(first(verify, "mutants"), "detected", json_false());
    json_object_set_new(first(faults, "faults"), "status", json_string("fail"));
    json_object_set_new(first(faults, "faults"), "detail", json_string("exit 1, not 0"));
    json_object_set_new(faults, "git", json_string("def"));
    return judged(results);
}

static void judge_page(json_t *results, const char *const *contents, size_t n)
{
    struct page page;
    char fault[256] = "";
    assert_true(page_make(&page, results));
    if (!markup_well_formed(page.html, fault, sizeof fault)) fail_msg("%s", fault);
    assert_null(markup_network(page.html));
    size_t sealed;
    char *whole = markup_unsealed(page.html, &sealed);
    assert_non_null(whole);
    if (!markup_well_formed(whole, fault, sizeof fault)) fail_msg("opened: %s", fault);
    assert_null(markup_network(whole));
    for (size_t k = 0; k < n; k++)
        if (!strstr(whole, contents[k])) fail_msg("the page lacks: %s", contents[k]);
    free(whole);
    assert_int_equal(page.plots.file_count,
                     json_array_size(json_object_get(results, "runs")) ? 14 : 0);
    page_free(&page);
    json_decref(results);
}

TEST(good_page)
{
    const char *const contents[] = {"<h1>All is well</h1>",
                                    "a &lt;b&gt; &amp; c",
                                    "q &lt; 1 &amp; more",
                                    "sphproof run sod",
                                    "sphproof converge sod",
                                    "cubic spline, ia",
                                    "0.9713003",
                                    "<h3>ia shear: holds in 1 of 2</h3>",
                                    "ia &lt; standard",
                                    "0.0625",
                                    "0.1031 %",
                                    "<b>1</b><span> of 1</span><br/>faults around it",
                                    "list | &lt;head",
                                    "faults.py disk",
                                    "4.61e-3"};
    judge_page(sound(), contents, sizeof contents / sizeof *contents);
}

TEST(bad_page)
{
    const char *const contents[] = {
        "<h1>5 failures; look first at kernels: sign (q &lt; 1 &amp; more)</h1>",
        "particle 7 &lt;negative u&gt;",
        "is too low",
        "nan is not &lt;= 1.00e-15",
        "&#39;minus&#39;",
        "sphproof verify --mutants",
        "exit 1, not 0",
        "with another build (git def)"};
    judge_page(unsound(), contents, sizeof contents / sizeof *contents);
}

static char *page_of(json_t *results)
{
    struct page page;
    assert_true(page_make(&page, results));
    size_t sealed;
    char *html = markup_unsealed(page.html, &sealed);
    assert_non_null(html);
    page_free(&page);
    json_decref(results);
    return html;
}

/* A case is folded, unless something is wrong with it. */
TEST(folded_cases)
{
    json_t *results = sound();
    char *good = page_of(results);
    assert_non_null(strstr(good, "<details class=\"case\" id=\"case-sod\"><summary>"));
    assert_non_null(strstr(good, "10 of 120 were tried, 87.5 % of those"));
    assert_non_null(strstr(good, "a &lt; b -&gt; &lt;="));
    assert_non_null(strstr(good, "ia 1.00 ± 0.10"));
    /* a mean says what one run may be off it, where that is much */
    assert_non_null(strstr(good, " ± 15 %</td>"));
    assert_null(strstr(good, " ± 2 %</td>"));
    assert_non_null(strstr(good, "plots/sod-conservation.dat"));
    assert_non_null(strstr(good, "plots/sod-regularity.dat"));
    assert_non_null(strstr(good, "Means over 9 runs"));
    results = sound();
    json_t *run = json_array_get(json_object_get(results, "runs"), 0);
    json_object_set_new(run, "status", json_string("broke_down"));
    char *bad = page_of(judged(results));
    assert_non_null(strstr(bad, "<details class=\"case\" id=\"case-sod\" open=\"open\"><summary>"));
    free(good);
    free(bad);
}

/* What is skipped: shares, whose source they name, the ratio of CPU times, and a map. */
TEST(skips)
{
    static const char *const contents[] = {"id=\"skips\"",
                                           "<code>sod n=8</code>",
                                           "<td class=\"n\">25 %</td>",
                                           "<td class=\"n\">50 %*</td>",
                                           "<td class=\"n\">0.80</td>",
                                           "plots/sod-asleep-1.dat",
                                           "sphproof bench sod n=8 --skips --samples 3"};
    json_t *results = sound();
    json_object_set_new(
        results, "skips",
        json_pack("[{s:s, s:[{s:s, s:f, s:f, s:s, s:f, s:f, s:f, s:f, s:s, s:[[f,f],[f,n]]}]}]",
                  "reproduce", "sphproof bench sod n=8 --skips --samples 3", "skips", "case", "sod",
                  "skipped_fraction", 0.25, "possible_fraction", 0.5, "possible_by",
                  "coarse threshold", "saves", 1.25, "spread", 0.03, "difference", 1e-12, "bound",
                  1e-8, "status", "pass", "asleep", 0., 0.5, 1.));
    struct page made;
    assert_true(page_make(&made, results));
    size_t map = 0;
    const size_t files = made.plots.file_count;
    while (map < files && strcmp(made.plots.files[map].name, "sod-asleep-1.dat") != 0) map++;
    assert_true(map < files);
    assert_non_null(strstr(made.plots.files[map].bytes, "\n 0 0.5\n 1 NaN\n"));
    page_free(&made);
    char *page = page_of(results);
    for (size_t k = 0; k < sizeof contents / sizeof *contents; k++)
        if (!strstr(page, contents[k])) fail_msg("the page lacks %s", contents[k]);
    free(page);
}

/* Other codes' errors stand beside ours where the same error is meant, and only there. */
TEST(other_codes)
{
    for (int same = 0; same < 2; same++) {
        json_t *results = sound();
        json_object_set_new(results, "bench",
                            json_pack("[{s:s, s:s, s:s, s:[{s:s, s:f}], s:[{s:s, s:f, s:f}]}]",
                                      "case", "kelvin_helmholtz", "error_of",
                                      same ? "mode_amplitude" : "density", "reproduce",
                                      "sphproof bench kelvin_helmholtz", "schemes", "scheme",
                                      "mine", "figure_of_merit", 1., "points", "scheme", "mine",
                                      "cpu_s", 1., "error", 0.1));
        char *page = page_of(results);
        assert_int_equal(strstr(page, "Athena++, 64^2") != NULL, same);
        assert_int_equal(strstr(page, "what other codes gave") != NULL, same);
        free(page);
    }
}

/* What orders are lost to: the sentence, the shares of the finest level, and a picture. */
TEST(autopsies)
{
    static const char *const contents[] = {"id=\"autopsies\"",
                                           "href=\"#autopsies\"",
                                           "The order, 1, is lost to disorder from 8^2 on: it is",
                                           "<td class=\"n\">0.750</td>",
                                           "<td class=\"n\">1.25</td>",
                                           "plots/yee-autopsy-1.dat",
                                           "sphproof autopsy yee --n 8^2,16^2"};
    static const char *const share = "{s:s, s:i, s:f, s:f, s:f, s:n, s:n}";
    json_t *results = sound(), *list = json_array();
    for (int n = 64; n <= 256; n *= 4)
        for (int k = 0; k < 2; k++)
            json_array_append_new(list, json_pack(share, "part", k ? "time_step" : "disorder", "n",
                                                  n, "share",
                                                  n == 64 ? 0.5
                                                  : k     ? 0.25
                                                          : 0.75,
                                                  "error", 0.1, "order", 1.25, "low", "high"));
    json_object_set_new(
        results, "autopsies",
        json_pack("[{s:s, s:s, s:i, s:s, s:o, s:s, s:[{s:i,s:f,s:f},{s:i,s:f,s:f}]}]", "case",
                  "yee", "title", "A vortex", "dim", 2, "sentence",
                  "The order, 1, is lost to disorder from 8^2 on: it is 75 % of the error",
                  "shares", list, "reproduce", "sphproof autopsy yee --n 8^2,16^2", "levels", "n",
                  64, "spacing", 0.125, "error", 0.2, "n", 256, "spacing", 0.0625, "error", 0.1));
    char *page = page_of(results);
    for (size_t k = 0; k < sizeof contents / sizeof *contents; k++)
        if (!strstr(page, contents[k])) fail_msg("the page lacks %s", contents[k]);
    assert_null(strstr(page, "<td class=\"n\">0.500</td>")); /* of the finest level alone */
    free(page);
}

/* One profile: density from 2 to 1 at x = 0, where pressure is 4 and one particle has 5. */
TEST(overshoots)
{
    json_t *results = sound();
    json_t *run = json_array_get(json_object_get(results, "runs"), 0);
    json_object_set_new(run, "settings", json_pack("{s:f}", "gamma", 1.5));
    json_object_set_new(run, "h", json_real(0.1));
    json_object_set_new(
        run, "profile",
        json_pack("{s:[f,f,f], s:[f,f,f], s:[f,f,f], s:[f,f,f], s:[f,f,f], s:[f,f,f], s:[f,f,f],"
                  " s:{s:[f,f,f,f], s:[f,f,f,f], s:[f,f,f,f], s:[f,f,f,f]}}",
                  "x", -0.9, -0.1, 0.9, "density", 2.25, 2., 1., "velocity", 0., 0., 0., "pressure",
                  9., 5., 4., "exact_density", 2., 2., 1., "exact_velocity", 0., 0., 0.,
                  "exact_pressure", 4., 4., 4., "exact", "x", -1., 0., 0., 1., "density", 2., 2.,
                  1., 1., "velocity", 0., 0., 0., 0., "pressure", 4., 4., 4., 4.));
    char *html = page_of(results);
    const char *table = strstr(html, "Overshoots");
    assert_non_null(table);
    /* 0.25 of 1; the particle at the contact is off by 1 of 4, the one with 9 is far from it */
    assert_non_null(strstr(table, "<td class=\"n\">25 %</td><td class=\"n\">—</td>"));
    assert_non_null(strstr(table, "<td class=\"n\">25 %</td></tr>"));
    free(html);
}

/* A case in 2D that is judged by a scalar: its error falls by 4 where n does by 4, which is order 2
 * against n^(1/2). */
TEST(in_two_dimensions)
{
    json_t *results = sound(), *run = first(results, "runs"), *study = first(results, "studies");
    json_object_set_new(run, "dimension", json_integer(2));
    json_object_set_new(study, "dimension", json_integer(2));
    json_object_set_new(study, "measured", json_pack("[s]", "mode_amplitude"));
    json_object_set_new(run, "measured", json_pack("[s]", "mode_amplitude"));
    json_array_append_new(json_object_get(study, "functionals"),
                          json_pack("{s:s, s:[f,f], s:f, s:f}", "name", "mode_amplitude", "values",
                                    0.5, 0.775, "extrapolated", 0.8, "exact", 0.9));
    json_array_append_new(json_object_get(study, "orders"),
                          json_pack("{s:s, s:s, s:f, s:f, s:f, s:[f], s:s}", "field",
                                    "mode_amplitude", "norm", "error", "order", 2.25, "low", 2.,
                                    "high", 2.5, "pairwise", 2.25, "status", "none"));
    json_object_set_new(
        run, "functionals",
        json_pack("[{s:s, s:f, s:f}]", "name", "mode_amplitude", "value", 0.775, "reference", 0.9));
    json_object_set_new(
        run, "profile",
        json_pack("{s:i, s:{s:[f,f], s:[f,f], s:[f,f,f,f], s:[f,f,f,f], s:[f,f,f,f]}, s:s, s:[s],"
                  " s:[f,f], s:[f,f], s:{s:[f,f], s:[f,f]}}",
                  "dim", 2, "map", "x", 0.25, 0.75, "y", 0.25, 0.75, "density", 1., 2., 1., 2.,
                  "speed", 0., 1., 0., 1., "error", 0.1, 0.2, 0.1, 0.2, "over", "R", "quantities",
                  "radial", "x", 0.1, 0.4, "radial", 0., 0.01, "exact", "x", 0., 0.5, "radial", 0.,
                  0.));
    char *html = page_of(results);
    assert_non_null(strstr(html, "In 2D: 1 case<"));
    assert_non_null(strstr(html, "order of the error of mode amplitude: ia 2.25 ± 0.25"));
    assert_non_null(strstr(html, "<td>mode amplitude</td><td class=\"n\">0.125</td>"));
    assert_non_null(strstr(html, "<td class=\"n\">0.4</td>")); /* of the coarse level */
    assert_non_null(strstr(html, "plots/sod-map-density.dat"));
    assert_non_null(strstr(html, "plots/sod-profiles.dat"));
    assert_null(strstr(html, "plots/sod-residuals.dat"));
    free(html);
}

/* What is known to fail is shown with its reason, and fails nothing. */
TEST(known)
{
    json_t *results = sound(), *order = first(first(results, "studies"), "orders");
    json_object_set_new(order, "status", json_string("known"));
    json_object_set_new(order, "known", json_string("few particles <there>"));
    char *html = page_of(judged(results));
    assert_non_null(
        strstr(html, "<h1>All that could be judged is well: 0 judged, 1 known weakness</h1>"));
    assert_non_null(strstr(html, "known</b>: few particles &lt;there&gt;"));
    free(html);
}

/* What a run in 2D has to keep: shown, and where it does not keep it the case is not well. */
TEST(gates)
{
    static const char *const statuses[] = {"pass", "known", "fail"};
    for (size_t k = 0; k < sizeof statuses / sizeof *statuses; k++) {
        json_t *results = sound(), *run = first(results, "runs");
        json_object_set_new(run, "dimension", json_integer(2));
        json_object_set_new(run, "gates",
                            json_pack("[{s:s, s:f, s:f, s:s, s:s}]", "name", "peak_density",
                                      "value", 0.375, "bound", 0.25, "status", statuses[k], "known",
                                      k == 1 ? "smeared <there>" : ""));
        char *html = page_of(judged(results));
        assert_non_null(strstr(html, "<td>peak density</td><td class=\"n\">0.375</td>"
                                     "<td class=\"n\">0.25</td>"));
        assert_int_equal(!strstr(html, "known</b>: smeared &lt;there&gt;"), k != 1);
        assert_int_equal(!strstr(html, "<h1>All "), k == 2);
        assert_int_equal(!strstr(html, "<details class=\"case\" id=\"case-sod\" open"), k != 2);
        free(html);
    }
}

/* What was reported a while ago was not last night. */
TEST(since)
{
    static const struct {
        const char *before, *words;
    } pairs[] = {{"2001-02-03T03:36:00Z", "24 minutes before"},
                 {"2001-02-03T03:59:59Z", "1 second before"},
                 {"2001-02-02T04:00:00Z", "24 hours before"},
                 {"2001-01-31T04:00:00Z", "3 days before"}};
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        json_t *results = sound();
        json_object_set_new(results, "date", json_string("2001-02-03T04:00:00Z"));
        json_object_set_new(results, "history",
                            json_pack("{s:{s:s, s:s, s:[], s:i}, s:[]}", "since", "date",
                                      pairs[i].before, "git", "def", "figures", "same", 3,
                                      "nights"));
        char *html = page_of(results);
        if (!strstr(html, pairs[i].words)) fail_msg("the page lacks: %s", pairs[i].words);
        assert_null(strstr(html, "ince last night"));
        free(html);
    }
}

/* What survived in the report before and breaks down now is a failure. */
TEST(broke_since)
{
    static const struct {
        const char *old, *new, *verdict;
        size_t failures;
    } pairs[] = {{"ok", "broke_down", "worse", 1},
                 {"broke_down", "ok", "better", 0},
                 {"ok", "inaccurate", "worse", 0}};
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        json_t *results = sound();
        json_object_set_new(results, "history",
                            json_pack("{s:{s:s, s:[{s:s, s:s, s:s, s:s}]}}", "since", "date", "x",
                                      "figures", "path", "stress.cells[noh, r, c].outcome", "old",
                                      pairs[i].old, "new", pairs[i].new, "verdict",
                                      pairs[i].verdict));
        judged(results);
        const json_t *failures = json_object_get(json_object_get(results, "verdict"), "failures");
        assert_int_equal(json_array_size(failures), pairs[i].failures);
        json_decref(results);
    }
}

/* Not by a colour alone; a scalar whose error falls does not diverge; one count of faults. */
TEST(words)
{
    json_t *results = sound(), *scalar, *checks = json_object_get(results, "verify");
    scalar = json_array_get(
        json_object_get(json_array_get(json_object_get(results, "studies"), 0), "functionals"), 0);
    json_object_set_new(scalar, "class", json_string("diverging"));
    json_object_set_new(scalar, "exact", json_real(0.95));
    json_array_append(json_object_get(checks, "mutants"),
                      json_array_get(json_object_get(checks, "mutants"), 0));
    json_object_set_new(results, "stress",
                        json_pack("{s:[{s:s, s:s, s:s, s:s, s:f}], s:[{s:s, s:s, s:[s], s:[s]}]}",
                                  "cells", "group", "noh", "row", "r", "column", "c", "outcome",
                                  "inaccurate", "measured", 0.5, "groups", "name", "noh", "title",
                                  "t", "rows", "r", "columns", "c"));
    char *html = page_of(results);
    assert_non_null(strstr(html, "its error falls, by irregular steps"));
    assert_null(strstr(html, ">diverging<"));
    assert_non_null(strstr(html, "1 deliberate faults"));
    assert_non_null(strstr(html, "2 trials, 2 caught"));
    assert_non_null(strstr(html, "≉ 0.5"));
    free(html);
}

/* Where no growth is predicted and none was found, round-off is no growth rate; and every map says
 * what its numbers are. */
TEST(growth_on_lattices)
{
    json_t *results = sound();
    json_object_set_new(
        results, "stress",
        json_pack("{s:[{s:s, s:s, s:s, s:s, s:f, s:n}, {s:s, s:s, s:s, s:s, s:f, s:f}], s:[{s:s, "
                  "s:s, s:s, s:s, s:s, s:f, s:[s], s:[s, s]}]}",
                  "cells", "group", "g", "row", "r", "column", "c", "outcome", "ok", "predicted",
                  5e-7, "measured", "group", "g", "row", "r", "column", "d", "outcome", "ok",
                  "predicted", 0.5, "measured", 0.25, "groups", "name", "g", "title", "t", "number",
                  "what it is", "row_title", "kernel", "column_title", "lattice", "stable_below",
                  0.02, "rows", "r", "columns", "c", "d"));
    char *html = page_of(results);
    assert_non_null(strstr(html, ">stable</td>"));
    assert_null(strstr(html, "5e-07"));
    assert_non_null(strstr(html, ">0.25 <span>of 0.5</span></td>"));
    assert_non_null(strstr(html, ">what it is</p>"));
    assert_non_null(strstr(html, "<th>kernel ↓ lattice →</th>"));
    free(html);
}

/* Results with nothing in them still make a page, and no verdict out of nothing. */
TEST(empty_page)
{
    const char *const contents[] = {"<h1>Nothing was checked</h1>"};
    judge_page(judged(json_object()), contents, 1);
}

TEST(page_without_gnuplot)
{
    char *path = strdup(getenv("PATH") ? getenv("PATH") : "");
    json_t *results = sound();
    struct page page;
    setenv("PATH", "/nowhere", 1);
    int made = page_make(&page, results);
    setenv("PATH", path, 1);
    free(path);
    assert_true(made);
    assert_int_equal(page.plots.missing, 7);
    assert_non_null(strstr(page.plots.message, "gnuplot"));
    size_t sealed;
    char *whole = markup_unsealed(page.html, &sealed);
    assert_non_null(whole);
    assert_null(strstr(whole, "<svg class=\"plot\""));
    assert_non_null(strstr(whole, "4.61e-3"));
    free(whole);
    page_free(&page);
    json_decref(results);
}

static size_t occurrences(const char *text, const char *what)
{
    size_t n = 0;
    for (; (text = strstr(text, what)); text += strlen(what)) n++;
    return n;
}

TEST(junit)
{
    char fault[256];
    json_t *good = sound(), *bad = unsound();
    char *passes = findings_junit(findings_of_report, good),
         *fails = findings_junit(findings_of_report, bad);
    if (!markup_well_formed(passes, fault, sizeof fault)) fail_msg("%s", fault);
    if (!markup_well_formed(fails, fault, sizeof fault)) fail_msg("%s", fault);
    assert_int_equal(occurrences(passes, "<testcase "), 6);
    assert_int_equal(occurrences(passes, "<failure "), 0);
    assert_int_equal(occurrences(fails, "<failure "), 5);
    free(passes);
    free(fails);
    json_decref(good);
    json_decref(bad);
}

TEST(summary)
{
    json_t *good = sound(), *bad = unsound();
    char *passes = summary_text(good), *fails = summary_text(bad);
    assert_non_null(strstr(passes, "All is well"));
    assert_non_null(strstr(passes, "| sod | ia | L1(density) | 1.00 | 0.90 to 1.10 | 5.00e-3 |"));
    assert_non_null(strstr(fails, "5 failures; look first at kernels: sign"));
    assert_int_equal(occurrences(fails, "\n- **"), 5);
    free(passes);
    free(fails);
    json_decref(good);
    json_decref(bad);
}

static void add_figure(json_t *checks, const char *group, const char *name, int rank,
                       const char *subject, double value)
{
    json_array_append_new(checks,
                          json_pack("{s:s, s:s, s:i, s:s, s:f, s:f, s:s}", "group", group, "name",
                                    name, "rank", rank, "subject", subject, "value", value, "bound",
                                    0.5, "status", value <= 0.5 ? "pass" : "fail"));
}

/* A wrong kernel: its own check leads, by its worst figure; what follows from it comes after. */
TEST(cause_first)
{
    json_t *results = sound(),
           *checks = json_object_get(json_object_get(results, "verify"), "checks");
    json_t *run = first(results, "runs"), *study = first(results, "studies");
    json_object_set_new(run, "status", json_string("broke_down"));
    json_object_set_new(study, "suspicion", json_string("the same error twice"));
    json_object_set_new(first(study, "orders"), "status", json_string("fail"));
    add_figure(checks, "hydro", "rates", 708, "cubic", 5e9);
    add_figure(checks, "kernels", "sign", 150, "well", 0.1);
    add_figure(checks, "kernels", "sign", 150, "mild", 1);
    add_figure(checks, "kernels", "slope", 150, "steep", 40);
    add_figure(checks, "kernels", "sign", 150, "worst", 20);
    add_figure(checks, "kernels", "sign", 150, "middle", 2);
    add_figure(checks, "kernels", "normalisation", 100, "one formula", 2);
    static const struct {
        const char *name, *detail;
    } expected[] = {{"kernels: normalisation", "one formula"},
                    {"kernels: slope", "steep: "},
                    {"kernels: sign", "worst: "},
                    {"hydro: rates", "cubic: "},
                    {"sod, ia", "too good to be true: the same error twice"},
                    {"sod, ia: order of l1(density)", "1"},
                    {"sod, ia", "broke down: "}};
    const json_t *failures =
        json_object_get(json_object_get(judged(results), "verdict"), "failures");
    assert_int_equal(json_array_size(failures), sizeof expected / sizeof *expected);
    for (size_t k = 0; k < sizeof expected / sizeof *expected; k++) {
        const json_t *failure = json_array_get(failures, k);
        const char *detail = json_string_value(json_object_get(failure, "detail"));
        assert_string_equal(json_string_value(json_object_get(failure, "name")), expected[k].name);
        if (strncmp(detail, expected[k].detail, strlen(expected[k].detail))) fail_msg("%s", detail);
        assert_int_equal(strstr(detail, "2 more figures") != NULL, k == 2);
    }
    char *xml = findings_junit(findings_of_report, results);
    assert_non_null(strstr(xml, "the same error twice"));
    free(xml);
    json_decref(results);
}

/* Nothing passes for well whose status nobody can read. */
TEST(unreadable)
{
    static const char *const lists[][2] = {
        {"runs", NULL}, {"studies", "orders"}, {"verify", "checks"}, {"faults", "faults"}};
    for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) {
        json_t *results = sound(), *list = json_object_get(results, lists[k][0]);
        if (json_is_array(list) && lists[k][1]) list = json_array_get(list, 0);
        if (lists[k][1]) list = json_object_get(list, lists[k][1]);
        json_object_set_new(json_array_get(list, 0), "status", json_string("passed"));
        const json_t *verdict = json_object_get(judged(results), "verdict");
        assert_string_equal(json_string_value(json_object_get(verdict, "status")), "fail");
        const char *detail = json_string_value(
            json_object_get(json_array_get(json_object_get(verdict, "failures"), 0), "detail"));
        assert_non_null(strstr(detail, "'status' is 'passed'; allowed: "));
        json_decref(results);
    }
}
