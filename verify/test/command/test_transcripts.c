/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares what commands print and write, and their exit statuses, with data/transcripts: word for
 * word, and numbers to seven digits. Round-off counts as 0, and what depends on the build or the
 * machine is left out. Arguments: the folder, and names of transcripts.
 *
 * A transcript: "$ WORDS" runs a command; its output follows, and "exit N" unless N is 0. A long
 * output is replaced by its number of lines and a digest. "< FILE" writes what follows, up to a
 * line ".", into FILE. "$ show FILE" prints a file (of rows of numbers their sums) or the names in
 * a folder. gnuplot is replaced by a program that keeps its script as drawn.gp. "$ WORDS > FILE"
 * sends standard output there, and not into the transcript. "$ compute report FOLDER" puts random
 * results for all that a quick report computes (drawn_pieces.h) into that cache. "$ damage FROM TO
 * vx=vy 1 2 9" exchanges two columns of the snapshot FROM in every second row from the first to
 * the ninth (all rows by default); "u*2" doubles one, "x+1" adds to it, "x.6" writes all columns
 * with six digits, "u!" gives one a name that nobody reads. With SPHPROOF_KEEP=FOLDER the correct
 * transcripts are written there, and the whole outputs as NAME.whole, to be compared with those of
 * another build. */
#include "test.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

#include "buffer.h"
#include "command.h"
#include "drawn_pieces.h"
#include "report.h"

enum { SHORT = 6, WORDS = 80, COLUMNS = 12, LINE_MAX = 1 << 16 };

static const char *folder;
static char own_folder[] = "sphproof_transcripts_XXXXXX";

/* ---- files ---- */

static char *read_all(const char *path)
{
    struct buffer text = {0};
    char part[4096];
    FILE *file = fopen(path, "r");
    if (!file) return NULL;
    for (size_t n; (n = fread(part, 1, sizeof part, file));) buffer_add_bytes(&text, part, n);
    fclose(file);
    return buffer_take(&text);
}

static void write_all(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

/* Reads a line of numbers, separated by blanks or commas. Returns how many there are, 0 if anything
 * else is in the line. */
static size_t numbers_of(const char *line, double values[COLUMNS])
{
    size_t n = 0;
    for (char *end; *line && *line != '\n'; line = end) {
        const double value = strtod(line, &end);
        if (end == line || n == COLUMNS) return 0;
        values[n++] = value;
        while (*end == ' ' || *end == ',') end++;
    }
    return n;
}

static void show_folder(struct buffer *to, const char *path)
{
    struct dirent **entries;
    const int n = scandir(path, &entries, NULL, alphasort);
    for (int i = 0; i < n; i++) {
        if (entries[i]->d_name[0] != '.') buffer_format(to, "%s\n", entries[i]->d_name);
        free(entries[i]);
    }
    free(entries);
}

/* Sums of the columns, and of the columns times the row's number, so that the order of rows
 * matters. */
static void show(struct buffer *to, const char *path)
{
    double sum[2 * COLUMNS] = {0}, values[COLUMNS];
    size_t rows = 0, width = 0, missing = 0;
    struct stat is;
    if (stat(path, &is) == 0 && S_ISDIR(is.st_mode)) {
        show_folder(to, path);
        return;
    }
    char *text = read_all(path);
    if (!text) {
        buffer_format(to, "no file %s\n", path);
        return;
    }
    for (char *line = text, *next; *line; line = next) {
        next = line + strcspn(line, "\n");
        if (*next) next++;
        const size_t n = numbers_of(line, values);
        if (rows && n != width) {
            buffer_format(to, "[%zu rows, %zu not a number:", rows, missing);
            for (size_t k = 0; k < 2 * width; k++) buffer_format(to, " %.12g", sum[k]);
            buffer_add(to, "]\n");
            rows = missing = 0;
            memset(sum, 0, sizeof sum);
        }
        if (!n) buffer_add_bytes(to, line, (size_t)(next - line));
        for (size_t k = 0; k < n; k++) {
            missing += isnan(values[k]) ? 1 : 0;
            if (isnan(values[k])) continue;
            sum[k] += values[k];
            sum[n + k] += values[k] * (double)(rows + 1);
        }
        if (n) width = n, rows++;
        if (n && !*next) buffer_format(to, "[%zu rows, %.12g, %.12g]\n", rows, sum[0], sum[n - 1]);
    }
    free(text);
}

/* ---- commands ---- */

/* Splits "a 'b c' d" into words and takes quotes away. */
static int split(char *line, char *words[WORDS])
{
    int n = 0;
    for (char *c = line; *c;) {
        while (*c == ' ') c++;
        if (!*c) break;
        assert_true(n < WORDS);
        char *to = words[n++] = c;
        for (char quote = 0; *c && (quote || *c != ' '); c++)
            if (quote ? *c == quote : *c == '\'' || *c == '"')
                quote = quote ? 0 : *c;
            else
                *to++ = *c;
        c += *c != 0;
        *to = 0;
    }
    return n;
}

/* The rest of a line after these words depends on the machine, the day or the build and is left
 * out. */
static const char *const left_out[] = {"\"version\": ",
                                       "\"git\": ",
                                       "\"compiler\": ",
                                       "\"flags\": ",
                                       "\"system\": ",
                                       "\"architecture\": ",
                                       "\"processor\": ",
                                       "\"cores\": ",
                                       "\"date\": ",
                                       "\"wall_s\": ",
                                       "\"cpu_s\": ",
                                       "\"peak_rss_bytes\": ",
                                       "\"memory_bytes\": ",
                                       "\ncost ",
                                       "pair interactions, ",
                                       "\nit would take ",
                                       "\"old_git\": ",
                                       "\"new_git\": ",
                                       "sphproof 0",
                                       "\"subject\": ",
                                       "\"floor\": ",
                                       "\"seconds\": ",
                                       "\"bytes\": ",
                                       " results, ",
                                       " skipped; ",
                                       "\nold  ",
                                       "\nnew  ",
                                       "\ngit ",
                                       "/cache; ",
                                       "\nreport: ",
                                       "\"git_before\": ",
                                       " time=\"",
                                       "\n\033[1mcost"};

/* Start of the blanks before the last word. */
static char *last_column(char *line)
{
    char *at = strrchr(line, ' ');
    while (at > line && at[-1] == ' ') at--;
    return at;
}

static void add_filtered(struct buffer *to, const char *text)
{
    bool cpu_column = false;
    char line[LINE_MAX];
    for (const char *next; *text; text = next) {
        size_t length = strcspn(text, "\n");
        next = text + length + (text[length] == '\n');
        assert_true(length + 2 < sizeof line);
        snprintf(line, sizeof line, "\n%.*s", (int)length, text);
        /* progress reports of a slow machine */
        if (strstr(line, " s left") || strstr(line, " (0 %), ")) continue;
        for (size_t k = 0; k < sizeof left_out / sizeof *left_out; k++) {
            char *at = strstr(line, left_out[k]);
            if (!at) continue;
            at += strlen(left_out[k]);
            /* a document written by hand: words of one letter */
            const char *git = strstr(at, ", git ");
            const bool by_hand = (at[0] == '"' && at[1] && at[2] == '"') || (git && git[7] == ',');
            if (!by_hand) strcpy(at, "~");
        }
        /* round-off errors and CPU times */
        for (size_t k = 0; k < 2; k++) {
            const char *ok = k ? "\n  \033[32mok  \033[0m " : "\n  ok   ";
            const size_t name = strlen(ok) + 18;
            if (!strncmp(line, ok, strlen(ok)) && strlen(line) > name) strcpy(line + name, "~");
        }
        /* the rest is a verdict with times */
        if (strncmp(line, "\nCPU time ", 10) == 0) strcpy(line + 10, "~"), next = "";
        const size_t end = strlen(line);
        if (cpu_column && isdigit((unsigned char)line[end - 1]) && line[1] == ' ')
            strcpy(last_column(line), " ~");
        else
            cpu_column = strstr(line, "  CPU s") != NULL;
        buffer_add(to, line + 1);
        if (text[length]) buffer_add(to, "\n");
    }
}

/* The text without what differs between machines: numbers have seven digits, those below 1e-11 are
 * 0, and one blank precedes a number of many digits. Long lists of allowed values, which grow, are
 * cut. */
static char *plain(const char *text)
{
    enum { LONGEST = 200 };
    struct buffer to = {0};
    char before = '\n';
    bool cut = false;
    for (size_t column = 0; *text; before = text[-1]) {
        if (before == '\n') {
            const char *list = strstr(text, "allowed: ");
            cut = list && list < text + strcspn(text, "\n");
        }
        const char *word = text + strspn(text, " ");
        const bool sign = *word == '-' || *word == '+';
        const bool begins =
            word > text || !(isalnum((unsigned char)before) || strchr("_.", before));
        if (begins && isdigit((unsigned char)word[sign])) {
            char *end;
            const double value = strtod(word, &end);
            if (!cut || column < LONGEST)
                buffer_format(&to, fabs(value) < 1e-11 ? "%s0" : "%s%.7g", word > text ? " " : "",
                              value);
            column += (size_t)(end - text), text = end;
        } else {
            const size_t n = word > text ? (size_t)(word - text) : 1;
            if (!cut || column < LONGEST || *text == '\n') buffer_add_bytes(&to, text, n);
            column = *text == '\n' ? 0 : column + n;
            text += n;
        }
    }
    return buffer_take(&to);
}

/* Adds a short output to a transcript as it is; of a long one the number of its lines and a digest.
 * All of it goes to the file `whole` unless that is NULL. */
static void add_output(struct buffer *to, FILE *whole, const char *text)
{
    size_t lines = 0;
    char *same = plain(text);
    for (const char *c = text; *c; c++) lines += *c == '\n';
    if (whole) fputs(same, whole);
    if (lines > SHORT)
        buffer_format(to, "[%zu lines, %016" PRIx64 "]\n", lines, text_digest(0, same));
    else
        buffer_add(to, same);
    free(same);
}

static void compute_report(const char *into)
{
    char drawn[2048];
    struct error error = {0};
    struct report *report;
    struct cache cache;
    snprintf(drawn, sizeof drawn, "%.2000s/../drawn", folder);
    json_t *template = read_template(drawn, "pieces.json");
    struct drawing draw = {0, template};
    assert_int_equal(report_create(false, NULL, 0, &report, &error), STATUS_OK);
    assert_int_equal(cache_open(&cache, into, false, &error), STATUS_OK);
    drawn_pieces(&draw, report_pool(report), 20);
    for (size_t i = 0; i < report_pool(report)->count; i++) {
        const struct pool_job *job = &report_pool(report)->jobs[i];
        json_t *reply = json_pack("{s:i, s:s, s:o?}", "status", (int)job->error.status, "message",
                                  job->error.message, "document", json_incref(job->document));
        assert_int_equal(cache_store(&cache, job->key, reply, &error), STATUS_OK);
        json_decref(reply);
    }
    report_destroy(report);
    json_decref(template);
}

static int column_of(const char *names, const char *name, size_t length)
{
    int column = 0;
    for (; *names && *names != '\n'; names += strcspn(names, ",\n") + 1, column++)
        if (strcspn(names, ",\n") == length && !strncmp(names, name, length)) return column;
    fail_msg("no column %s", name);
    return -1;
}

/* words: FROM TO CHANGE [FIRST STRIDE LAST] */
static void damage(char **words, int n)
{
    const long first = n > 3 ? atol(words[3]) : 1, stride = n > 4 ? atol(words[4]) : 1,
               last = n > 5 ? atol(words[5]) : 1L << 30;
    const size_t length = strcspn(words[2], "=*+!.");
    const char how = words[2][length], *by = words[2] + length + 1;
    const int digits = how == '.' ? atoi(by) : 17;
    char *text = read_all(words[0]);
    struct buffer to = {0};
    assert_non_null(text);
    const int column = column_of(text, words[2], length),
              other = how == '=' ? column_of(text, by, strlen(by)) : column;
    long row = 0;
    char *line = text, *next;
    if (how == '!') {
        for (int k = 0; k < column; k++) line += strcspn(line, ",") + 1;
        buffer_add_bytes(&to, text, (size_t)(line - text));
        buffer_add(&to, "no_");
    }
    for (; *line; line = next) {
        double values[COLUMNS];
        next = line + strcspn(line, "\n") + 1;
        const size_t columns = numbers_of(line, values);
        row += columns > 0;
        if (!columns || row < first || row > last || (row - first) % stride) {
            buffer_add_bytes(&to, line, (size_t)(next - line));
            continue;
        }
        const double old = values[column];
        values[column] = how == '=' ? values[other] : how == '*' ? old * atof(by) : old;
        if (how == '+') values[column] += atof(by);
        if (how == '=') values[other] = old;
        for (size_t k = 0; k < columns; k++)
            buffer_format(&to, "%.*g%s", digits, values[k], k + 1 < columns ? "," : "\n");
    }
    free(text);
    text = buffer_take(&to);
    write_all(words[1], text);
    free(text);
}

/* Runs a command in this process; both streams go to one file, except a redirected standard
 * output. */
static void run(struct buffer *result, FILE *whole, char *line)
{
    struct buffer output = {0}, shown = {0}, *to = &output;
    char *text;
    char program[] = "sphproof", *words[WORDS + 1] = {program};
    int n = 1 + split(line, words + 1);
    const char *elsewhere = n > 3 && !strcmp(words[n - 2], ">") ? words[n - 1] : NULL;
    if (elsewhere) n -= 2;
    if (n == 4 && !strcmp(words[1], "compute")) {
        compute_report(words[3]);
        return;
    }
    if (n > 4 && !strcmp(words[1], "damage")) {
        damage(words + 2, n - 2);
        return;
    }
    if (n > 2 && !strcmp(words[1], "show")) {
        show(&shown, words[2]);
        text = buffer_take(&shown);
        add_filtered(to, text);
        free(text);
        goto end;
    }
    words[n] = NULL;
    fflush(NULL);
    const int out = dup(1), err = dup(2);
    assert_non_null(freopen("output", "w", stdout));
    dup2(1, 2);
    if (elsewhere) assert_non_null(freopen(elsewhere, "w", stdout));
    const int status = command_main(n, words);
    fflush(NULL);
    dup2(out, 1), dup2(err, 2);
    close(out), close(err);
    text = read_all("output");
    add_filtered(to, text);
    if (to->size && to->data[to->size - 1] != '\n') buffer_add(to, "\n");
    if (status) buffer_format(to, "exit %d\n", status);
    free(text);
end:
    text = buffer_take(to);
    add_output(result, whole, text);
    free(text);
}

/* ---- transcripts ---- */

static void transcript(void **state)
{
    const char *name = *state, *keep = getenv("SPHPROOF_KEEP");
    char path[4096], line[LINE_MAX];
    struct buffer made = {0}, file = {0};
    bool skipping = false, writing = false;
    FILE *whole = NULL;
    if (keep) {
        snprintf(path, sizeof path, "%s/%s.whole", keep, name);
        whole = fopen(path, "w");
        assert_non_null(whole);
    }
    snprintf(path, sizeof path, "%s/%s.txt", folder, name);
    char *expected = read_all(path), written[128] = "";
    if (!expected) fail_msg("%s: %s", path, strerror(errno));
    for (const char *text = expected, *next; *text; text = next) {
        const size_t length = strcspn(text, "\n");
        next = text + length + (text[length] == '\n');
        snprintf(line, sizeof line, "%.*s", (int)length, text);
        const bool command = !writing && !strncmp(line, "$ ", 2),
                   input = !writing && !strncmp(line, "< ", 2);
        if (command || input) skipping = false;
        if (!skipping) buffer_add_bytes(&made, text, (size_t)(next - text));
        if (command) {
            skipping = true;
            if (whole) fprintf(whole, "%s\n", line);
            run(&made, whole, line + 2);
        } else if (input) {
            writing = true;
            snprintf(written, sizeof written, "%.100s", line + 2);
        } else if (writing && !strcmp(line, ".")) {
            char *content = buffer_take(&file);
            write_all(written, content);
            free(content);
            writing = false;
        } else if (writing) {
            buffer_add_bytes(&file, text, (size_t)(next - text));
        }
    }
    char *found = buffer_take(&made);
    assert_non_null(found);
    if (keep) {
        snprintf(path, sizeof path, "%s/%s.txt", keep, name);
        write_all(path, found);
    } else {
        size_t at = 0, command = 0;
        while (found[at] && found[at] == expected[at]) at++;
        for (size_t k = 0; k < at; k++)
            if (!strncmp(found + k, "\n$ ", 3)) command = k + 1;
        if (found[at] != expected[at])
            fail_msg("%s: is not what it was (see verify/test/keep):\n%.600s", name,
                     found + command);
    }
    free(found);
    free(expected);
    if (whole) fclose(whole);
}

/* Makes a folder with a gnuplot that draws nothing and an ffmpeg that only copies. */
static int begin(void **state)
{
    (void)state;
    char path[8192], here[4096];
    if (!mkdtemp(own_folder) || chdir(own_folder) || !getcwd(here, sizeof here)) return 1;
    write_all("gnuplot", "#!/bin/sh\nsed '/^print/q' >drawn.gp\n"
                         "if grep -q '^load' drawn.gp; then cat /dev/fd/3 >drawn.gp; fi\n"
                         "echo \"<svg viewBox='0 0 1 1'>\n</svg>\"\n");
    write_all("ffmpeg", "#!/bin/sh\nfor to; do :; done\n"
                        "[ $1 = -version ] || (echo \"${*% *}\"; cat) >\"${to#file:}\"\n");
    chmod("gnuplot", 0755), chmod("ffmpeg", 0755);
    snprintf(path, sizeof path, "%s:%s", here, getenv("PATH") ? getenv("PATH") : "/usr/bin:/bin");
    return setenv("PATH", path, 1) || setenv("TERM", "dumb", 1);
}

static int end(void **state)
{
    (void)state;
    char command[64];
    snprintf(command, sizeof command, "rm -r %s", own_folder);
    return chdir("..") || system(command);
}

int main(int argc, char **argv)
{
    struct CMUnitTest tests[32] = {{0}};
    if (argc < 3 || argc > 34 || argv[1][0] != '/') return 2;
    folder = argv[1];
    for (int k = 2; k < argc; k++)
        tests[k - 2] =
            (struct CMUnitTest){.name = argv[k], .test_func = transcript, .initial_state = argv[k]};
    return _cmocka_run_group_tests("transcripts", tests, (size_t)argc - 2, begin, end);
}
