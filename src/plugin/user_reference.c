/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "user_reference.h"

#include <dlfcn.h>
#include <math.h>
#include <stdio.h>

#include "guard.h"

static const char symbol[] = "sphproof_reference";

enum status user_reference_load(struct user_reference *user, const char *path, struct error *error)
{
    char plain[4096];
    /* without a slash dlopen would search the system directories */
    snprintf(plain, sizeof plain, "%s%s", strchr(path, '/') ? "" : "./", path);
    guard_call("dlopen", (double)NAN, (double)NAN, 0);
    user->library = dlopen(plain, RTLD_NOW | RTLD_LOCAL);
    guard_back();
    if (!user->library)
        return error_set(error, STATUS_BAD_INPUT, "reference '%.150s' is no shared object: %.250s",
                         path, dlerror());
    void *address = dlsym(user->library, symbol);
    memcpy(&user->state, &address, sizeof address); /* POSIX: a data pointer can hold it */
    if (user->state) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT, "reference '%.150s' has no function %s (see %s.h)",
                     path, symbol, "sphproof/reference");
}

void user_reference_state(const struct user_reference *user, const double x[3], double t,
                          const struct sphproof_reference_case *of,
                          struct sphproof_reference_state *state)
{
    const double nan = (double)NAN;
    const struct sphproof_reference_state unknown = {nan, {nan, nan, nan}, nan, nan};
    *state = unknown;
    guard_call(symbol, x[0], t, of->dim);
    const int known = user->state(x, t, of, state);
    guard_back();
    if (known != 0) *state = unknown;
}
