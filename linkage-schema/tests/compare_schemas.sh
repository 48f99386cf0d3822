#!/bin/bash
# Compares the verdicts of linkage.xsd with those of another schema of the format, such as the published MeshLink.xsd (which
# is under a licence of its own and is not part of this project):
#     cargo test -p linkage-schema --test schema      # leaves the corpus in the target directory
#     tests/compare_schemas.sh MeshLink.xsd CORPUS_DIR_OR_FILE...
# Prints every document on which they differ; exit 1 if there is one.
set -euo pipefail
[ $# -ge 2 ] || { echo "usage: $0 OTHER.xsd DIRECTORY_OR_XML..." >&2; exit 2; }
command -v xmllint >/dev/null || { echo "xmllint is missing: apt-get install libxml2-utils" >&2; exit 2; }
ours=$(dirname "$(realpath "$0")")/../linkage.xsd
other=$1
shift
documents=$(mktemp)
trap 'rm -f "$documents" "$documents.ours" "$documents.other"' EXIT
find "$@" -type f -name '*.xml' -print0 | sort -z > "$documents"
verdicts() { xargs -0 xmllint --noout --schema "$1" < "$documents" 2>&1 | grep -E ' (validates|fails to validate)$' | sort; }
verdicts "$ours" > "$documents.ours" || true
verdicts "$other" > "$documents.other" || true
echo "$(tr -cd '\0' < "$documents" | wc -c) documents; accepted by ours: $(grep -c ' validates$' "$documents.ours" || true), by the other: $(grep -c ' validates$' "$documents.other" || true)"
diff "$documents.ours" "$documents.other" && echo "no difference"
