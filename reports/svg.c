/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "script.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "style.h"

struct slice {
    const char *at;
    size_t n;
};

struct attribute {
    struct slice name, value;
};

enum { ATTRIBUTES = 24 };

struct tag {
    struct slice name;
    struct attribute attributes[ATTRIBUTES];
    size_t count;
    bool end, empty; /* </g>, <path .../> */
};

static bool is(struct slice slice, const char *string)
{
    return slice.n == strlen(string) && !memcmp(slice.at, string, slice.n);
}

static const char *skip_space(const char *c)
{
    while (isspace((unsigned char)*c)) c++;
    return c;
}

/* The value of a tag's attribute; empty: there is none. */
static struct slice value_of(const struct tag *tag, const char *name)
{
    for (size_t k = 0; k < ATTRIBUTES; k++)
        if (is(tag->attributes[k].name, name)) return tag->attributes[k].value;
    return (struct slice){.at = ""};
}

/* Parses the tag that starts at c ('<'); returns the text after it, NULL if malformed. */
static const char *parse(const char *c, struct tag *tag)
{
    *tag = (struct tag){0};
    c++;
    if (*c == '/') tag->end = true, c++;
    tag->name.at = c;
    while (isalnum((unsigned char)*c) || *c == ':') c++;
    tag->name.n = (size_t)(c - tag->name.at);
    for (c = skip_space(c); *c && *c != '>' && *c != '/'; c = skip_space(c)) {
        if (tag->count == ATTRIBUTES) return NULL;
        struct attribute *attribute = &tag->attributes[tag->count++];
        attribute->name.at = c;
        while (*c && *c != '=' && !isspace((unsigned char)*c)) c++;
        attribute->name.n = (size_t)(c - attribute->name.at);
        c = skip_space(c);
        if (*c != '=') return NULL;
        c = skip_space(c + 1);
        char mark = *c++;
        if (mark != '"' && mark != '\'') return NULL;
        attribute->value.at = c;
        c = strchr(c, mark);
        if (!c) return NULL;
        attribute->value.n = (size_t)(c - attribute->value.at);
        c++;
    }
    if (*c == '/') tag->empty = true, c++;
    return *c == '>' ? c + 1 : NULL;
}

/* The style of a paint: "black", "rgb(0,114,178)", "#0072b2"; STYLE_COUNT: none. */
static int style_of(struct slice paint)
{
    if (is(paint, "black")) return STYLE_plot_ink;
    int r, g, b;
    char copy[32] = "";
    if (paint.n >= sizeof copy) return STYLE_COUNT;
    memcpy(copy, paint.at, paint.n);
    if (sscanf(copy, "rgb(%d,%d,%d)", &r, &g, &b) != 3) return STYLE_COUNT;
    char hex[32];
    snprintf(hex, sizeof hex, "#%02x%02x%02x", (unsigned)r & 255, (unsigned)g & 255,
             (unsigned)b & 255);
    int style = 0;
    while (style < STYLE_COUNT && strcmp(style_colors[style].light, hex)) style++;
    return style;
}

static void put(struct buffer *to, const char *name, struct slice value)
{
    buffer_format(to, " %s=\"", name);
    buffer_add_bytes(to, value.at, value.n);
    buffer_add(to, "\"");
}

/* Writes an attribute. A paint of the style becomes currentColor, and *color its style. */
static void put_attribute(struct buffer *to, const struct attribute *attribute, const char *prefix,
                          int *color)
{
    struct slice name = attribute->name, value = attribute->value;
    bool paint = is(name, "fill") || is(name, "stroke");
    int style = paint || is(name, "color") ? style_of(value) : STYLE_COUNT;
    if (is(name, "color")) {
        if (style < STYLE_COUNT && style != STYLE_plot_ink) *color = style;
        return; /* the text colour is inherited from the page; white is used only for halos */
    }
    if (is(name, "font-family") || is(name, "class")) return;
    if (paint && style < STYLE_COUNT) {
        if (style != STYLE_plot_ink) *color = style;
        value = (struct slice){"currentColor", 12};
    }
    if (is(name, "id")) {
        buffer_format(to, " id=\"%s-%.*s\"", prefix, (int)value.n, value.at);
    } else if (is(name, "xlink:href") && value.n && value.at[0] == '#') {
        buffer_format(to, " href=\"#%s-%.*s\"", prefix, (int)value.n - 1, value.at + 1);
    } else if (is(name, "xlink:href")) { /* an image with its data */
        put(to, "href", value);
        buffer_add(to, " style=\"image-rendering:pixelated\"");
    } else {
        char copy[64];
        snprintf(copy, sizeof copy, "%.*s", (int)name.n, name.at);
        put(to, copy, value);
    }
}

static void put_tag(struct buffer *to, const struct tag *tag, const char *prefix)
{
    int color = STYLE_COUNT;
    buffer_format(to, "<%s%.*s", tag->end ? "/" : "", (int)tag->name.n, tag->name.at);
    for (size_t k = 0; k < tag->count; k++) put_attribute(to, &tag->attributes[k], prefix, &color);
    if (color < STYLE_COUNT)
        buffer_format(to, " class=\"%s\" color=\"%s\"", style_colors[color].css,
                      style_colors[color].light);
    buffer_add(to, tag->empty ? "/>" : ">");
}

static void put_root(struct buffer *to, const struct tag *tag, const char *prefix,
                     const char *title)
{
    const struct slice view = value_of(tag, "viewBox");
    buffer_add(to, "<svg class=\"plot\" role=\"img\" xmlns=\"http://www.w3.org/2000/svg\" "
                   "font-family=\"sans-serif\" color=\"");
    buffer_format(to, "%s\" aria-labelledby=\"%s-title\"", style_colors[STYLE_plot_ink].light,
                  prefix);
    if (view.n) put(to, "viewBox", view);
    buffer_format(to, ">\n<title id=\"%s-title\">", prefix);
    buffer_escape(to, title);
    buffer_add(to, "</title>\n");
}

/* Particles: gnuplot writes a filled circle as a <use> of some hundred bytes. A sequence of circles
 * of one size and colour becomes one path of dots (zero-length segments with round caps), a tenth
 * as long. */
struct dots {
    bool open;
    double scale;
    int style;
};

static bool is_dot(const struct tag *tag, double *x, double *y, struct dots *dots)
{
    const char *place = value_of(tag, "transform").at;
    dots->style = style_of(value_of(tag, "color"));
    return is(tag->name, "use") && is(value_of(tag, "xlink:href"), "#gpPt6") &&
           dots->style < STYLE_COUNT &&
           sscanf(place, "translate(%lf,%lf) scale(%lf)", x, y, &dots->scale) == 3;
}

static void end_dots(struct buffer *to, struct dots *dots)
{
    if (dots->open) buffer_add(to, "\"/>\n");
    dots->open = false;
}

/* Returns true if the tag was a dot, and writes it. */
static bool put_dot(struct buffer *to, const struct tag *tag, struct dots *dots)
{
    struct dots now = {.open = true};
    double x, y;
    if (!is_dot(tag, &x, &y, &now)) return false;
    if (dots->open &&
        (now.style != dots->style || now.scale < dots->scale || now.scale > dots->scale))
        end_dots(to, dots);
    if (!dots->open)
        buffer_format(to,
                      "<path fill=\"none\" stroke=\"currentColor\" stroke-linecap=\"round\" "
                      "stroke-width=\"%.2f\" class=\"%s\" color=\"%s\" d=\"",
                      2 * now.scale, style_colors[now.style].css, style_colors[now.style].light);
    buffer_format(to, "M%.1f %.1fh0", x, y);
    *dots = now;
    return true;
}

/* Open groups. Empty groups are removed, for which the start of each is recorded. */
enum { DEPTH = 32 };

struct groups {
    size_t start[DEPTH];   /* position of the tag in the text */
    size_t content[DEPTH]; /* position after the tag */
    size_t depth;
};

static bool is_white_use(const struct tag *tag)
{
    return is(tag->name, "use") && is(value_of(tag, "color"), "white");
}

static bool drop_element(const struct tag *tag)
{
    return is(tag->name, "desc") || is(tag->name, "title") || is(tag->name, "filter");
}

bool svg_adapt(struct buffer *to, const char *raw, const char *prefix, const char *title)
{
    const char *c = strstr(raw, "<svg");
    if (!c) return false;
    struct groups groups = {0};
    struct tag tag;
    struct dots dots = {0};
    while (*c) {
        if (*c != '<') { /* text content matters only in <text>, whose tags put it in place */
            const char *end = strchr(c, '<');
            size_t n = end ? (size_t)(end - c) : strlen(c);
            if (skip_space(c) < c + n) buffer_add_bytes(to, c, n);
            c += n;
            continue;
        }
        const char *after = parse(c, &tag);
        if (!after) return false;
        c = after;
        if (put_dot(to, &tag, &dots)) continue;
        end_dots(to, &dots);
        if (!tag.end && drop_element(&tag)) {
            char end[32];
            snprintf(end, sizeof end, "</%.*s>", (int)tag.name.n, tag.name.at);
            c = strstr(c, end);
            if (!c) return false;
            c += strlen(end);
        } else if (is(tag.name, "svg") && !tag.end) {
            put_root(to, &tag, prefix, title);
        } else if (is(tag.name, "g") && !tag.end) {
            if (groups.depth == DEPTH) return false;
            groups.start[groups.depth] = to->size;
            put_tag(to, &tag, prefix);
            groups.content[groups.depth++] = to->size;
        } else if (is(tag.name, "g")) {
            if (!groups.depth) return false;
            groups.depth--;
            if (to->failed) return false;
            if (to->size == groups.content[groups.depth])
                to->data[to->size = groups.start[groups.depth]] = '\0';
            else
                buffer_add(to, "</g>\n");
        } else if (!is_white_use(&tag)) {
            put_tag(to, &tag, prefix);
            if (tag.end && is(tag.name, "svg")) return !to->failed;
        }
    }
    return false;
}
