/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs a target without libFuzzer. `replay N FOLDER ...` gives it every file of these folders, then
 * N inputs made from them by random cuts, copies and changes, the same ones each time. */
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { INPUTS_MAX = 1024, SIZE_LARGEST = 1 << 13, SECONDS_MAX = 20 };

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

struct input {
    size_t size;
    uint8_t bytes[SIZE_LARGEST];
};

static struct input inputs[INPUTS_MAX], now;
static uint64_t state = 1;

/* Steele, Lea & Flood 2014, splitmix64; below end. */
static size_t below(size_t end)
{
    uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return end ? (size_t)(z % end) : 0;
}

/* Keeps the input that crashes or hangs. */
static void keep(int number)
{
    static const char told[] = "the input is in crash.input\n";
    const int file = open("crash.input", O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (file >= 0 && write(file, now.bytes, now.size) == (ssize_t)now.size)
        if (write(STDERR_FILENO, told, sizeof told - 1) < 0) abort();
    signal(number, SIG_DFL);
    raise(number);
}

static void try(void)
{
    alarm(SECONDS_MAX);
    LLVMFuzzerTestOneInput(now.bytes, now.size);
    alarm(0);
}

/* Adds the files of a folder; returns the new number of inputs. */
static size_t read_corpus(const char *folder, size_t count)
{
    DIR *list = opendir(folder);
    for (struct dirent *entry; list && count < INPUTS_MAX && (entry = readdir(list));) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        FILE *file = entry->d_name[0] == '.' ? NULL : fopen(path, "rb");
        if (!file) continue;
        inputs[count].size = fread(inputs[count].bytes, 1, SIZE_LARGEST, file);
        fclose(file);
        count++;
    }
    if (list) closedir(list);
    return count;
}

/* Replaces part of the input by part of another one, or by bytes with a meaning. */
static void change(const struct input *other)
{
    static const char *const words[] = {"\n", "=", ",",      "-",  "1e308", "0",    "nan", "\xff",
                                        "[",  "]", "1e-308", "\"", "{",     "auto", " ",   ""};
    const char *word = words[below(sizeof words / sizeof *words)];
    const bool insert_word = below(2);
    const size_t from = below(other->size + 1), length = below(1 + below(other->size - from + 1));
    const uint8_t *bytes = insert_word ? (const uint8_t *)word : other->bytes + from;
    const size_t added = insert_word ? strlen(word) : length;
    const size_t at = below(now.size + 1), gone = below(2) ? 0 : below(1 + (now.size - at) / 4);
    const size_t rest = now.size - at - gone;
    if (at + added + rest > SIZE_LARGEST) return;
    memmove(now.bytes + at + added, now.bytes + at + gone, rest);
    memcpy(now.bytes + at, bytes, added);
    now.size = at + added + rest;
    if (now.size && below(4) == 0) now.bytes[below(now.size)] ^= (uint8_t)(1u << below(8));
}

int main(int argc, char **argv)
{
    const int numbers[] = {SIGABRT, SIGALRM, SIGSEGV, SIGFPE, SIGBUS};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) signal(numbers[i], keep);
    const long more = argc > 1 ? atol(argv[1]) : 0;
    size_t count = 0;
    for (int i = 2; i < argc; i++) count = read_corpus(argv[i], count);
    if (!count) {
        fprintf(stderr, "usage: replay N FOLDER ...; the folders hold at least one input\n");
        return 2;
    }
    for (size_t i = 0; i < count; i++) {
        now = inputs[i];
        try();
    }
    for (long i = 0; i < more; i++) {
        now = inputs[below(count)];
        for (size_t changes = 1 + below(6); changes-- > 0;) change(&inputs[below(count)]);
        try();
    }
    printf("%zu inputs and %ld changed ones\n", count, more);
    return 0;
}
