#!/usr/bin/env bash
# Where OpenCV's calibrateCamera stops depends on the LAPACK under it, which Debian exchanges without a word to OpenCV (update-alternatives): the same program on the same
# points has another camera once OpenBLAS is installed beside the reference LAPACK. The difference is far below a standard
# deviation, and where photographs have nearly one angle far above rounding: whoever compares such results to 1e-6 px compares machines. With one library it is the same each time.
# Seen: libopencv-calib3d406 4.6.0+dfsg-12 with liblapack3 3.11.0-2 and libopenblas0-pthread 0.3.21+ds-4 (Debian 12, x86-64, one thread), twelve views of 9 x 6 corners:
#   tilt 0.40 rad: fx 898.3789147458 by the reference, 898.3789147458 by OpenBLAS, 3.5e-11 px apart
#   tilt 0.02 rad: fx 765.5690920921 by the reference, 765.5691398340 by OpenBLAS, 4.8e-05 px apart
# Where views hardly tell the camera the last step is long, and rounding decides when it is taken for the last.
# The digits after the sixth depend on the processor, since OpenBLAS takes other ways on others.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
pkg-config --exists opencv4 && command -v g++ >/dev/null || { echo "needs g++ and libopencv-dev"; exit 2; }
cat > "$folder/calibrate.cpp" <<'CPP'
#include <opencv2/calib3d.hpp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

static double normal() {
    static uint64_t state = 7;
    double sum = -6;
    for (int i = 0; i < 12; ++i) {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        sum += double(state >> 11) / double(1ULL << 53);
    }
    return sum;
}

int main(int, char** arguments) {
    const double tilt = std::atof(arguments[1]);
    cv::setNumThreads(1);
    const cv::Matx33d k(900, 0, 645, 0, 901, 478, 0, 0, 1);
    const cv::Vec<double, 5> lens(-0.2, 0.08, 5e-4, -3e-4, -0.01);
    std::vector<cv::Point3f> board;
    for (int i = 0; i < 54; ++i) board.emplace_back(25.f * (i % 9), 25.f * (i / 9), 0.f);
    std::vector<std::vector<cv::Point3f>> objects;
    std::vector<std::vector<cv::Point2f>> images;
    for (int view = 0; view < 12; ++view) {
        const cv::Vec3d turn(tilt * std::sin(1.7 * view), tilt * std::cos(2.3 * view), 0.3 * view);
        const cv::Vec3d shift(-100 + 8 * (view % 5), -60 + 6 * (view % 3), 320 + 15 * view);
        std::vector<cv::Point3d> points(board.begin(), board.end());
        std::vector<cv::Point2d> seen;
        cv::projectPoints(points, turn, shift, k, lens, seen);
        std::vector<cv::Point2f> noisy;
        for (const auto& at : seen) {
            const double x = at.x + 0.3 * normal(), y = at.y + 0.3 * normal();
            noisy.emplace_back(float(x), float(y));
        }
        objects.push_back(board);
        images.push_back(noisy);
    }
    cv::Mat camera, distortion;
    std::vector<cv::Mat> turns, shifts;
    const double rms = cv::calibrateCamera(objects, images, {1280, 960}, camera, distortion, turns, shifts);
    std::printf("%.17g %.17g %.17g\n", rms, camera.at<double>(0, 0), distortion.at<double>(0));
}
CPP
# shellcheck disable=SC2046
g++ -O1 "$folder/calibrate.cpp" -o "$folder/calibrate" $(pkg-config --cflags opencv4) -lopencv_calib3d -lopencv_core
cd "$folder"
apt-get download -q liblapack3=3.11.0-2 libblas3=3.11.0-2 libopenblas0-pthread=0.3.21+ds-4 >/dev/null 2>&1 || { echo "the packages of Debian 12 cannot be had"; exit 2; }
for package in *.deb; do dpkg -x "$package" unpacked; done
of() { LD_LIBRARY_PATH="$1" OPENBLAS_NUM_THREADS=1 ./calibrate "$2"; }
libraries="$folder/unpacked/usr/lib/x86_64-linux-gnu"
for tilt in 0.4 0.02; do
    of "$libraries/lapack:$libraries/blas" "$tilt"
    of "$libraries/lapack:$libraries/blas" "$tilt"
    of "$libraries/openblas-pthread" "$tilt"
done > seen
python3 - <<'PYTHON'
rows = [[float(word) for word in line.split()] for line in open("seen")]
off = []
for tilt, (reference, again, openblas) in (("0.40", rows[:3]), ("0.02", rows[3:])):
    assert reference == again, "the same library ends elsewhere"
    off.append(abs(reference[1] - openblas[1]))
    print(f"tilt {tilt} rad: fx {reference[1]:.10f} by the reference, {openblas[1]:.10f} by OpenBLAS, {off[-1]:.1e} px apart")
assert off[0] < 1e-8 < 1e-7 < off[1] < 1e-2, off
PYTHON
echo "as stated"
