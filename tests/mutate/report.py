"""What came of the faults: a table, the survivors, and the list of faults that cannot matter."""
import os

EQUIVALENT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "equivalent.txt")


def equivalents(path=EQUIVALENT):
    """{name of a fault: reason}. In the file: the name on a line, below it the reason, indented."""
    out, name = {}, None
    for line in open(path, encoding="utf-8").read().split("\n") if os.path.exists(path) else []:
        if not line.strip() or line.startswith("#"):
            continue
        if line[0].isspace():
            if name is None:
                raise SystemExit(f"{path}: a reason without a fault: {line}")
            out[name] = (out[name] + " " + line.strip()).strip()
        else:
            name = line.strip()
            out[name] = ""
    bare = [n for n, reason in out.items() if not reason]
    if bare:
        raise SystemExit(f"{path}: no reason for: {bare[0]}")
    return out


def verdict_of(fault, verdicts, reasons):
    """"killed", "survived", "equivalent", "looks" or "open" (not tried yet). Looks are faults that shift, pad or tint
    something on screen by a little: their reason begins with "looks:"."""
    verdict = verdicts.get(fault.name(), {}).get("verdict", "open")
    if verdict != "survived" or fault.name() not in reasons:
        return verdict
    return "looks" if reasons[fault.name()].startswith("looks:") else "equivalent"


def row(room, placed, reached, tried, verdicts, reasons):
    found = [verdict_of(f, verdicts, reasons) for f in tried]
    killed, survived, equivalent, looks = (found.count(v) for v in ("killed", "survived", "equivalent", "looks"))
    total, matter = killed + survived + equivalent + looks, killed + survived
    share = f"{100 * killed / matter:.1f} %" if matter else "-"
    return f"| {room} | {placed} | {reached} | {total} | {killed} | {equivalent} | {looks} | {survived} | {share} |"


HEAD = ("| room | placed | reached | tried | killed | equivalent | looks | survivors | killed of killed and survivors |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |")


def by_rule(tried, verdicts, reasons):
    counts = {}
    for fault in tried:
        verdict = verdict_of(fault, verdicts, reasons)
        if verdict != "open":
            counts.setdefault(fault.rule, {}).setdefault(verdict, []).append(fault)
    return "\n".join(f"  {rule:16} killed {len(v.get('killed', [])):3}  survived {len(v.get('survived', [])):3}  "
                     f"equivalent or looks {len(v.get('equivalent', [])) + len(v.get('looks', [])):3}" for rule, v in sorted(counts.items()))


def survivors(tried, verdicts, reasons):
    lines = []
    for fault in sorted(tried, key=lambda f: (f.file, f.line)):
        if verdict_of(fault, verdicts, reasons) == "survived":
            lines.append(f"{fault.file}:{fault.line}: {fault.rule}\n    {fault.name()}")
    return "\n".join(lines)
