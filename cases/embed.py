# SPDX-License-Identifier: GPL-3.0-or-later
"""embed.py OUTPUT.c CASE.ini ...: the case files as a C array of names and texts."""
import json
import os
import sys

with open(sys.argv[1], "w", encoding="ascii") as output:
    output.write('#include "cases.h"\n\nconst struct case_builtin case_builtins[] = {\n')
    for path in sys.argv[2:]:
        with open(path, encoding="ascii") as text:
            lines = "\n".join("     %s" % json.dumps(line) for line in text)
        name = os.path.splitext(os.path.basename(path))[0]
        output.write('    {"%s",\n%s},\n' % (name, lines))
    output.write("    {0, 0},\n};\n")
