/* SPDX-License-Identifier: GPL-3.0-or-later
 * Code files: another SPH program, described so that every command that runs our solver runs it.
 *
 *   [code]
 *   title = SWIFT, SPHENIX
 *   ic = swift                 ; a format of `sphproof ic`, or a command that makes @IC@
 *   parameters = swift.yml.in  ; templates, filled in beside the initial state
 *   command = ./swift --hydro --threads=@THREADS@ @PARAMETERS@
 *   snapshot = @OUT@_*.hdf5    ; the last one is judged
 *   [case gresho]              ; a case that it can run; keys of [code] that differ; n and gates
 *   n = 32^2 48^2 64^2 96^2
 *   velocity_l1 = 0.5 1.2 0.2
 *   [fault slow]               ; the same program with a deliberate fault: keys that differ
 *   command = ./swift_faulty @PARAMETERS@
 *
 * Each run has a folder of its own, in which the command starts. A word of a command that names a
 * file beside the code file stands for that file. Paths of templates and `depends` are relative to
 * the code file. Every key and every @WORD@ is checked when the file is read, but programs are
 * looked for when a case is run. */
#pragma once

#include "cases.h"
#include "family.h"
#include "ini_text.h"
#include "start_format.h"

/* NAME, fallback, allowed, meaning. */
#define CODE_KEY_LIST(KEY)                                                                         \
    KEY(title, "the file's name", "a text", "name of the code")                                    \
    KEY(ic, "csv", "a format of `sphproof ic`, or a command that has @IC@",                        \
        "format of initial states, or the command that writes them")                               \
    KEY(parameters, "", "files, separated by blanks",                                              \
        "templates, filled in for each run; a name loses .in at its end; @PARAMETERS@ is the "     \
        "first")                                                                                   \
    KEY(command, "", "a program and its arguments",                                                \
        "command that computes a run, in a folder of its own")                                     \
    KEY(snapshot, "", "a path of which parts may be * ? or [abc]",                                 \
        "snapshots that the run writes, of which the longest, last name is judged")                \
    KEY(timeout, "600", "seconds, above 0", "limit of a run's wall time")                          \
    KEY(memory, "none", "a number with MB or GB, or none",                                         \
        "limit of memory for all processes of a run together")                                     \
    KEY(depends, "", "files, separated by blanks",                                                 \
        "other files on which results depend: a change of them makes kept runs invalid")           \
    KEY(elements, "particles", "particles cells",                                                  \
        "elements of the gas: cells of a grid exchange mass, so a snapshot need not have the "     \
        "particles of the initial state")                                                          \
    KEY(as_3d, "no", "no, or a number of layers",                                                  \
        "cases in 2D are given to the code as so many periodic layers in 3D, and judged in 2D")    \
    KEY(equal_masses, "no", "yes no", "initial states have particles of equal masses")             \
    KEY(shell, "no", "yes no", "the command is a line for sh, in which no word is a file")

enum code_key {
#define KEY(name, fallback, allowed, meaning) CODE_##name,
    CODE_KEY_LIST(KEY)
#undef KEY
        CODE_KEYS
};
struct code_key_text {
    const char *name, *fallback, *allowed, *meaning;
};
extern const struct code_key_text code_keys[CODE_KEYS];

/* @NAME@ in commands, templates and the snapshot's name. */
#define CODE_WORD_LIST(WORD)                                                                       \
    WORD(IC, "the file of the initial state")                                                      \
    WORD(CASE, "the name of the case")                                                             \
    WORD(OUT, "first part of the names of snapshots")                                              \
    WORD(PARAMETERS, "the first template, filled in")                                              \
    WORD(T_END, "the time at which the run ends")                                                  \
    WORD(N, "the number of particles")                                                             \
    WORD(SPACING, "(box/n)^(1/d)")                                                                 \
    WORD(DIM, "the number of dimensions")                                                          \
    WORD(LO,                                                                                       \
         "lower ends of the box, as the initial state counts positions: one for each direction")   \
    WORD(HI, "upper ends of the box")                                                              \
    WORD(GAMMA, "the ratio of specific heats")                                                     \
    WORD(THREADS, "--threads")                                                                     \
    WORD(SEED, "the key seed")                                                                     \
    WORD(HERE, "the folder of the code file")

enum code_word {
#define WORD(name, meaning) CODE_WORD_##name,
    CODE_WORD_LIST(WORD)
#undef WORD
        CODE_WORDS
};
extern const struct member *const code_words[CODE_WORDS]; /* name, meaning */

enum { CODE_NAME = 64, CODE_FAULTS_MAX = 16, CODE_PATH = 1024 };

/* How a case or a fault is run: the values of the file, "" for unset keys. */
struct code_way {
    char value[CODE_KEYS][INI_TEXT_LINE + 1];
    int line[CODE_KEYS]; /* line in the file */
};

struct code_case {
    struct case_file file; /* with the code's own n and gates */
    struct code_way way;   /* complete */
};

struct code_fault {
    char name[CODE_NAME];
    struct code_way way; /* only the keys that it sets */
};

struct code {
    char path[CODE_PATH], folder[CODE_PATH]; /* the file; its folder, absolute */
    struct code_way way;                     /* of [code] */
    size_t case_count, fault_count;
    struct code_case *cases;
    struct code_fault faults[CODE_FAULTS_MAX];
};

/* STATUS_BAD_INPUT: file, line, key and what is allowed; nothing is then left to free. */
enum status code_load(struct code *code, const char *path, struct error *error);
void code_free(struct code *code);

/* NAME of the section "KIND NAME"; NULL: it is another section. */
const char *code_section_name(const char *section, const char *kind);

/* A case with a fault: keys that the fault does not set are the case's. */
void code_with_fault(const struct code_case *of, const struct code_fault *fault,
                     struct code_case *faulty);

/* The case of that name. NULL: STATUS_BAD_INPUT in error, which lists the cases of the file. */
const struct code_case *code_case_of(const struct code *code, const char *name,
                                     struct error *error);

/* The value of a key, or its fallback if unset. */
const char *code_value(const struct code_way *way, enum code_key key);
double code_timeout(const struct code_way *way);
double code_memory(const struct code_way *way); /* bytes; INFINITY: no limit */
/* True if the key, set or not, has this word as its value: code_is(way, CODE_shell, "yes"). */
bool code_is(const struct code_way *way, enum code_key key, const char *word);
/* The format of initial states; NULL: ic is a command. */
const struct start_format *code_format(const struct code_way *way);

/* The path of a file that the code file names, in CODE_PATH bytes; false: too long. */
bool code_beside(const struct code *code, const char *name, size_t length, char path[CODE_PATH]);

/* Takes the next word of a blank-separated list, in which "..." is one word; NULL at the end.
 * *length: of the word. */
const char *code_next_word(const char **rest, size_t *length);

/* The text with every @WORD@ replaced; malloced. values: of CODE_WORDS. NULL: no memory. */
char *code_fill(const char *text, const char *const *values);

/* The first unknown @WORD@, in CODE_NAME bytes; false: all are known. */
bool code_unknown_word(const char *text, char word[CODE_NAME]);
