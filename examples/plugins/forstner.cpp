// Förstner's corner, as in forstner.py. No library reads the line here: its keys are sought in it.
#include <cmath>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

static double number(const std::string& line, const std::string& key) {
    return std::stod(line.substr(line.find("\"" + key + "\":") + key.size() + 3));
}

int main() {
    std::string line;
    std::getline(std::cin, line);
    const int half = int(number(line, "window")) / 2;
    std::cout << "{\"version\": 1}" << std::endl;
    while (std::getline(std::cin, line)) {
        const int width = int(number(line, "width")), height = int(number(line, "height"));
        std::vector<float> grey(size_t(width) * height);
        std::cin.read(reinterpret_cast<char*>(grey.data()), std::streamsize(number(line, "bytes")));
        std::istringstream starts(line.substr(line.find("\"starts\":[") + 10));
        std::ostringstream out;
        out.precision(17);
        double x, y;
        for (char bracket, comma; starts >> bracket && bracket == '[' && starts >> x >> comma >> y >> bracket; starts >> comma) {
            const int x0 = int(std::lround(x)), y0 = int(std::lround(y)), reach = half + 1;
            double sxx = 0, sxy = 0, syy = 0, sx = 0, sy = 0;
            if (x0 >= reach && y0 >= reach && x0 + reach < width && y0 + reach < height)
                for (int r = y0 - half; r <= y0 + half; ++r)
                    for (int c = x0 - half; c <= x0 + half; ++c) {
                        const float* at = &grey[size_t(r) * width + c];
                        const double gx = at[1] - at[-1], gy = at[width] - at[-width];
                        sxx += gx * gx, sxy += gx * gy, syy += gy * gy;
                        sx += gx * gx * c + gx * gy * r, sy += gx * gy * c + gy * gy * r;
                    }
            const double det = sxx * syy - sxy * sxy;
            out << (out.tellp() > 0 ? "," : "");
            if (det <= 1e-3 * (sxx + syy) * (sxx + syy)) out << "null";
            else out << '[' << (syy * sx - sxy * sy) / det << ',' << (sxx * sy - sxy * sx) / det << ']';
        }
        std::cout << "{\"image\": " << int(number(line, "image")) << ", \"xy\": [" << out.str() << "]}" << std::endl;
    }
}
