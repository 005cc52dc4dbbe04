# Answers each image with its starts.
while IFS= read -r line; do
    case $line in
    *'"bytes":'*)
        bytes=${line#*\"bytes\":}
        head -c "${bytes%%[,\}]*}" >/dev/null
        starts=${line#*\"starts\":}
        image=${line#*\"image\":}
        printf '{"image":%s,"xy":%s]]}\n' "${image%%[,\}]*}" "${starts%%\]\]*}" ;;
    *) echo '{"version":"1"}' ;;
    esac
done
