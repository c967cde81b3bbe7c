/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "h5.h"

#include <dlfcn.h>
#include <pthread.h>
#include <string.h>

#include "h5_soname.h"

struct h5 h5;
static char failure[300];

/* Finds a function (size = 0), or copies the value of a variable of `size` bytes. */
static void find(void *library, const char *symbol, void *result, size_t size)
{
    void *address = dlsym(RTLD_DEFAULT, symbol); /* a linked program has copies of variables */
    if (!address) address = dlsym(library, symbol);
    if (!address)
        snprintf(failure, sizeof failure, "%s is not in %s", symbol, H5_SONAME);
    else
        memcpy(result, size ? address : &address, size ? size : sizeof address);
}

static void load(void)
{
#define TEXT(name)       #name
#define SYMBOL(name)     TEXT(name) /* some names are macros for a versioned name */
#define CALL(name)       find(library, SYMBOL(H5##name), &h5.name, 0);
#define IDENTIFIER(name) find(library, SYMBOL(H5##name), &h5.name, sizeof h5.name);
    void *library = dlopen(H5_SONAME, RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        snprintf(failure, sizeof failure, "%s", dlerror());
        return;
    }
    H5_CALLS(CALL)
    if (failure[0]) return;
    h5.open(); /* initialises the identifiers */
    H5_IDENTIFIERS(IDENTIFIER)
    h5.Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

enum status h5_load(const char *path, struct error *error)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, load);
    if (!failure[0]) return STATUS_OK;
    return error_set(error, STATUS_ENVIRONMENT, "%.200s: the HDF5 library cannot be loaded: %.200s",
                     path, failure);
}
