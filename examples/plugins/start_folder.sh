# Answers each image with its starts: measured.csv is points.csv without what is not asked for.
# A program that measures would read images/* here; its parameters are in CALIBENCH_NAME.
awk -F, -v OFS=, '
    NR == 1 { for (i = 1; i <= NF; i++) column[$i] = i }
    { print $column["image"], $column["target"], $column["x"], $column["y"] }
' points.csv > measured.csv
