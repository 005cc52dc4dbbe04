# Answers each image with its starts.
while IFS= read -r line; do
    case $line in
    *'"bytes":'*)
        bytes=${line#*\"bytes\":}
        head -c "${bytes%%[,\}]*}" >/dev/null
        starts=${line#*\"starts\":}
        printf '{"xy":%s]]}\n' "${starts%%\]\]*}" ;;
    *) echo '{"version":"1"}' ;;
    esac
done
