/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "page_part.h"

#include <stdlib.h>
#include <string.h>

#include "base64.h"

#ifdef HAVE_ZLIB
#include <zlib.h>

/* Compresses a text; malloced; NULL: no memory. */
static unsigned char *pack(const char *text, size_t size, size_t *packed)
{
    uLongf most = compressBound((uLong)size);
    unsigned char *bytes = malloc(most);
    if (bytes && compress2(bytes, &most, (const Bytef *)text, (uLong)size, 9) != Z_OK) {
        free(bytes);
        return NULL;
    }
    *packed = most;
    return bytes;
}

void fold_seal(struct buffer *to, size_t start)
{
    size_t packed = 0;
    if (to->failed || to->size == start) return;
    unsigned char *bytes = pack(to->data + start, to->size - start, &packed);
    if (!bytes) {
        to->failed = true;
        return;
    }
    to->data[to->size = start] = '\0';
    buffer_add(to, "<div class=\"sealed\" data-z=\"");
    base64_add(to, bytes, packed);
    buffer_add(to, "\"></div>\n");
    free(bytes);
}

#else

void fold_seal(struct buffer *to, size_t start)
{
    (void)to, (void)start;
}

#endif

void fold_section(struct buffer *to, size_t start)
{
    static const char head[] = "<h2>", head_end[] = "</h2>", end[] = "</section>\n";
    if (to->failed || to->size == start) return;
    char *section = strdup(to->data + start);
    char *at = section ? strstr(section, head) : NULL, *rest = at ? strstr(at, head_end) : NULL;
    const size_t length = section ? strlen(section) : 0;
    if (!section) to->failed = true;
    if (rest && length >= sizeof end && !strcmp(section + length - (sizeof end - 1), end)) {
        to->data[to->size = start] = '\0';
        buffer_add_bytes(to, section, (size_t)(at - section));
        buffer_add(to, "<details class=\"part\"><summary>");
        rest += sizeof head_end - 1;
        buffer_add_bytes(to, at, (size_t)(rest - at));
        buffer_add(to, "</summary>\n");
        const size_t inside = to->size;
        buffer_add_bytes(to, rest, length - (size_t)(rest - section) - (sizeof end - 1));
        fold_seal(to, inside);
        buffer_add(to, "</details></section>\n");
    }
    free(section);
}

/* Without '<' and '&', since the page is also XML. */
const char fold_script[] =
    "<noscript><p class=\"note\">What is folded is kept compressed and opens with JavaScript only. "
    "All figures are in <a href=\"results.json\">results.json</a>, the data and scripts of all "
    "plots in the folder <code>plots</code>.</p></noscript>\n"
    "<script>(function () {\n"
    "function inflate(box) {\n"
    "  var data = box.getAttribute('data-z');\n"
    "  if (!data) return Promise.resolve();\n"
    "  box.removeAttribute('data-z');\n"
    "  if (typeof DecompressionStream === 'undefined') {\n"
    "    box.textContent = 'This browser cannot inflate what is folded: see results.json and the "
    "folder plots.';\n"
    "    return Promise.resolve();\n"
    "  }\n"
    "  var bytes = Uint8Array.from(atob(data), function (c) { return c.charCodeAt(0); });\n"
    "  var stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));\n"
    "  return new Response(stream).text().then(function (text) { box.innerHTML = text; });\n"
    "}\n"
    "function open(details) {\n"
    "  details.open = true;\n"
    "  return Promise.all(Array.from(details.children).filter(function (child) {\n"
    "    return child.className === 'sealed'; }).map(inflate));\n"
    "}\n"
    "function show() {\n"
    "  var at = document.getElementById(decodeURIComponent(location.hash.slice(1))), all = [];\n"
    "  if (!at) return;\n"
    "  var first = at.tagName === 'SECTION' ? at.querySelector('details.part') : null;\n"
    "  if (first) all.push(open(first));\n"
    "  for (var up = at; up; up = up.parentElement) if (up.tagName === 'DETAILS') "
    "all.push(open(up));\n"
    "  Promise.all(all).then(function () { at.scrollIntoView(); });\n"
    "}\n"
    "document.addEventListener('toggle', function (event) {\n"
    "  if (event.target.open) open(event.target);\n"
    "}, true);\n"
    "addEventListener('hashchange', show);\n"
    "document.addEventListener('click', function (event) {\n"
    "  var link = event.target.closest ? event.target.closest('a') : null;\n"
    "  if (link) if (link.getAttribute('href') === location.hash) show();\n"
    "});\n"
    "show();\n"
    "})();</script>\n";
