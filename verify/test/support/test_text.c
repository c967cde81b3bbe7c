/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the parsing of words and numbers, temporary and whole files, and SHA-256. */
#include "test.h"

#include <locale.h>
#include <unistd.h>

#include "output.h"
#include "sha256.h"
#include "text.h"

TEST(numbers_are_strict)
{
    static const char *const good[] = {"1", "-1", "+1", "1e3", ".5", "5.", "1E-3", "-0", "2.385"};
    static const char *const bad[] = {"",    " ",     " 1",    "1 ",  "1e3x",    "0x10", "nan",
                                      "inf", "-inf",  "1e999", "1,5", "--1",     "e3",   "1e",
                                      ".",   "1.2.3", "1\n",   "1_0", "infinity"};
    double value;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) assert_true(text_real(good[i], &value));
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        value = 2.385;
        assert_false(text_real(bad[i], &value));
        near_relative(value, 2.385, 1e-16);
    }
    assert_true(text_integer("1e3", &value));
    near_relative(value, 1000, 1e-16);
    assert_false(text_integer("1.0", &value));
    assert_false(text_integer("1e-3", &value));
}

/* If a program has set a locale with a decimal comma, nothing changes. */
TEST(a_comma_changes_nothing)
{
    static const char *const names[] = {"", "de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8",
                                        "pl_PL.UTF-8"};
    double value = 0;
    bool comma = false;
    for (size_t i = 0; i < sizeof names / sizeof *names && !comma; i++)
        comma = setlocale(LC_NUMERIC, names[i]) && *localeconv()->decimal_point == ',';
    if (!comma) {
        print_message("no locale with a decimal comma here\n");
        skip();
    }
    numbers_are_strict(state);
    assert_true(text_real("-12.25e1", &value));
    near_relative(value, -122.5, 1e-16);
    setlocale(LC_NUMERIC, "C");
}

TEST(lists_have_their_length)
{
    double v[3];
    assert_true(text_reals("1 -2  0.4", " \t,", 3, v));
    near_relative(v[1], -2, 1e-16);
    near_relative(v[2], 0.4, 1e-16);
    assert_true(text_reals(" 1,2,3 ", " \t,", 3, v));
    assert_true(text_reals("-1:1:11", ":", 3, v));
    near_relative(v[2], 11, 1e-16);
    assert_false(text_reals("1 2", " \t,", 3, v));
    assert_false(text_reals("1 2 3 4", " \t,", 3, v));
    assert_false(text_reals("1 2 x", " \t,", 3, v));
    assert_false(text_reals("1:2:", ":", 3, v));
    static const char *const ends[] = {"1:2:", "1,2,", "1,2 ,", "1,2, ",
                                       ":1:2", ",1,2", "1::2",  "1,,2"};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++)
        assert_false(text_reals(ends[i], i % 2 || i == 2 ? "," : ":", 2, v));
    assert_false(text_reals("", " \t,", 1, v));
}

TEST(distances)
{
    assert_int_equal(text_distance("", ""), 0);
    assert_int_equal(text_distance("abc", ""), 3);
    assert_int_equal(text_distance("kitten", "sitting"), 3);
    assert_int_equal(text_distance("kernal", "kernel"), 1);
    assert_int_equal(text_distance("lsit", "list"), 1);
    assert_int_equal(text_distance("SOD", "sod"), 0);
}

TEST(near_misses)
{
    static const char *const names[] = {"quadratic_spline", "cubic_spline", "wendland_c2", "sinc"};
    assert_string_equal(text_nearest("cubic", names, 4), "cubic_spline");
    assert_string_equal(text_nearest("Cubic_Spline", names, 4), "cubic_spline");
    assert_string_equal(text_nearest("wendlandc2", names, 4), "wendland_c2");
    assert_string_equal(text_nearest("sink", names, 4), "sinc");
    assert_null(text_nearest("frobnicate", names, 4));
    assert_null(text_nearest("", names, 4));
}

TEST(messages_are_printable)
{
    static const char *const names[] = {"one", "two"};
    struct error error;
    assert_int_equal(text_unknown(&error, "f:3", "key", "t\nw\x80o", names, 2), STATUS_BAD_INPUT);
    for (const char *c = error.message; *c; c++) assert_in_range(*c, ' ', '~');
    assert_non_null(strstr(error.message, "f:3"));
    assert_non_null(strstr(error.message, "one two"));
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void expect_text(const char *path, const char *text)
{
    char got[64] = "";
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    got[fread(got, 1, sizeof got - 1, file)] = '\0';
    fclose(file);
    assert_string_equal(got, text);
}

TEST(files_appear_whole)
{
    char folder[] = "sphproof-test-XXXXXX", path[64], link[64];
    struct output output;
    struct error error;
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/file", folder);
    snprintf(link, sizeof link, "%s/link", folder);
    write_text(path, "old");
    assert_int_equal(symlink("file", link), 0);

    assert_int_equal(output_open(&output, path, &error), STATUS_OK);
    fputs("new", output.stream);
    fflush(output.stream);
    expect_text(path, "old");
    output_discard(&output);
    expect_text(path, "old");

    assert_int_equal(output_open(&output, link, &error), STATUS_OK);
    fputs("new", output.stream);
    assert_int_equal(output_close(&output, &error), STATUS_OK);
    expect_text(path, "new"); /* the link's target has changed, and not the link */
    assert_int_equal(unlink(link), 0);

    assert_int_equal(output_probe(path, &error), STATUS_OK);
    assert_int_equal(output_open(&output, folder, &error), STATUS_ENVIRONMENT);
    assert_int_equal(output_open(&output, "/dev/full", &error), STATUS_OK);
    fputs("new", output.stream);
    assert_int_equal(output_close(&output, &error), STATUS_ENVIRONMENT);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(rmdir(folder), 0); /* no other file is left in it */
}

/* A temporary file is created in TMPDIR, and nowhere else if that folder does not exist. */
TEST(temporaries)
{
    char folder[] = "sphproof-test-XXXXXX", text[8] = "";
    const char *old = getenv("TMPDIR");
    char *before = old ? strdup(old) : NULL;
    assert_non_null(mkdtemp(folder));
    setenv("TMPDIR", folder, 1);
    FILE *file = output_temporary();
    assert_non_null(file);
    assert_true(fputs("here", file) >= 0);
    rewind(file);
    assert_int_equal(fread(text, 1, sizeof text, file), 4);
    assert_memory_equal(text, "here", 4);
    fclose(file);
    assert_int_equal(rmdir(folder), 0); /* no file is left */
    assert_null(output_temporary());
    if (before)
        setenv("TMPDIR", before, 1);
    else
        unsetenv("TMPDIR");
    free(before);
}

/* Examples of FIPS 180, in parts that are not multiples of its blocks. */
TEST(sums_are_those_of_the_standard)
{
    static const struct {
        const char *text, *sum;
        size_t times;
    } examples[] = {
        {"", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855", 1},
        {"abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad", 1},
        {"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq",
         "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1", 1},
        {"aaaaaaaaaa", "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0", 100000}};
    for (size_t k = 0; k < sizeof examples / sizeof *examples; k++) {
        char sum[SHA256_TEXT];
        struct sha256 of;
        sha256_begin(&of);
        for (size_t i = 0; i < examples[k].times; i++)
            sha256_add(&of, examples[k].text, strlen(examples[k].text));
        sha256_end(&of, sum);
        assert_string_equal(sum, examples[k].sum);
    }
}

/* What does not fit is cut; what stands behind the text stays. */
TEST(text_grows_to_its_size)
{
    for (size_t size = 1; size <= 12; size++) {
        char text[16], whole[16] = "";
        memset(text, '#', sizeof text);
        *text = '\0';
        for (int i = 0; i < 3; i++) text_add(text, size, "%d,%c", i, 'a' + i);
        snprintf(whole, size, "0,a1,b2,c");
        assert_string_equal(text, whole);
        for (size_t i = size; i < sizeof text; i++) assert_int_equal(text[i], '#');
    }
}
