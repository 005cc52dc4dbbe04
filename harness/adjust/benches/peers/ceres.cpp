// A board or a bundle, adjusted by Ceres Solver: `peers/ceres.rs` writes the problem and reads the answer.
//
//     ceres ROUNDS TOLERANCE RADIUS COVARIANCE < problem
//
// A problem is numbers: images, points, observations, controls, whether the points are unknown (0 or 1); fx, fy, cx, cy, k1, k2, p1, p2, k3 to start
// from; of each image its rotation by rows and its translation (x right, y down, z forward); of each point X, Y, Z; of each observation image, point,
// x, y, standard deviation; of each control point its number, X, Y, Z, standard deviation. TOLERANCE is the relative change of the
// sum of squares at which it stops, RADIUS the first one of its trust region (its default: 1e4), COVARIANCE the number of rounds of the covariance.
//
// Output, one line: seconds of ceres::Solve alone (best round), the solver, its steps, weighted sum of squares, nine parameters, their nine
// standard deviations (a priori), seconds of ceres::Covariance for the interior orientation and all poses (best round; -1 if it was not asked for).
//
// Derivatives are automatic (AutoDiffCostFunction). Dense and sparse Schur complements alternate and the faster counts; one thread.

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace {

using Camera = std::array<double, 9>;
using Pose = std::array<double, 6>;
using Point = std::array<double, 3>;

template <typename T>
void residual(const double* measured, double weight, const T* camera, const T* pose, const T* point, T* into) {
    T n[3];
    ceres::AngleAxisRotatePoint(pose, point, n);
    const T x = (n[0] + pose[3]) / (n[2] + pose[5]), y = (n[1] + pose[4]) / (n[2] + pose[5]);
    const T *k = camera + 4, r2 = x * x + y * y;
    const T radial = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    const T xd = x * radial + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x);
    const T yd = y * radial + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y;
    into[0] = weight * (camera[0] * xd + camera[2] - measured[0]);
    into[1] = weight * (camera[1] * yd + camera[3] - measured[1]);
}

// An image point whose object point is known.
struct Corner {
    double measured[2], weight;
    Point at;

    template <typename T>
    bool operator()(const T* camera, const T* pose, T* into) const {
        const T point[3] = {T(at[0]), T(at[1]), T(at[2])};
        residual(measured, weight, camera, pose, point, into);
        return true;
    }
};

struct Sight {
    double measured[2], weight;

    template <typename T>
    bool operator()(const T* camera, const T* pose, const T* point, T* into) const {
        residual(measured, weight, camera, pose, point, into);
        return true;
    }
};

struct Control {
    Point at;
    double weight;

    template <typename T>
    bool operator()(const T* point, T* into) const {
        for (int i = 0; i < 3; ++i) into[i] = weight * (point[i] - at[i]);
        return true;
    }
};

double number() {
    double value;
    if (!(std::cin >> value)) {
        std::cerr << "the problem ends too early\n";
        std::exit(2);
    }
    return value;
}

size_t count() { return static_cast<size_t>(number()); }

// Values of all unknowns; blocks stay where they are, because Ceres knows them by address.
struct Values {
    Camera camera;
    std::vector<Pose> poses;
    std::vector<Point> points;
};

struct Network {
    Values start, now;
    ceres::Problem problem;
    bool free_points;

    void read() {
        const size_t images = count(), points = count(), observations = count(), controls = count();
        free_points = count() != 0;
        for (double& value : start.camera) value = number();
        for (size_t i = 0; i < images; ++i) {
            double rotation[9];
            for (double& value : rotation) value = number();
            Pose pose;
            ceres::RotationMatrixToAngleAxis(ceres::RowMajorAdapter3x3(static_cast<const double*>(rotation)), pose.data());
            for (int k = 3; k < 6; ++k) pose[k] = number();
            start.poses.push_back(pose);
        }
        start.points.resize(points);
        for (Point& point : start.points) {
            for (double& value : point) value = number();
        }
        now = start;
        for (size_t i = 0; i < observations; ++i) observation();
        for (size_t i = 0; i < controls; ++i) control();
    }

    void observation() {
        const size_t image = count(), point = count();
        const double x = number(), y = number(), weight = 1.0 / number();
        double *camera = now.camera.data(), *pose = now.poses.at(image).data(), *at = now.points.at(point).data();
        if (free_points) {
            problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Sight, 2, 9, 6, 3>(new Sight{{x, y}, weight}), nullptr, camera, pose, at);
        } else {
            const Corner corner{{x, y}, weight, now.points[point]};
            problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Corner, 2, 9, 6>(new Corner(corner)), nullptr, camera, pose);
        }
    }

    void control() {
        double* point = now.points.at(count()).data();
        const double x = number(), y = number(), z = number(), weight = 1.0 / number();
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Control, 3, 3>(new Control{{x, y, z}, weight}), nullptr, point);
    }

    // The start values, at the same addresses.
    void reset() {
        now.camera = start.camera;
        std::copy(start.poses.begin(), start.poses.end(), now.poses.begin());
        std::copy(start.points.begin(), start.points.end(), now.points.begin());
    }

    // Points are eliminated, or the poses before known points.
    ceres::ParameterBlockOrdering* order() {
        auto* ordering = new ceres::ParameterBlockOrdering;
        ordering->AddElementToGroup(now.camera.data(), 1);
        for (Pose& pose : now.poses) ordering->AddElementToGroup(pose.data(), free_points ? 1 : 0);
        for (Point& point : now.points) {
            if (free_points && problem.HasParameterBlock(point.data())) ordering->AddElementToGroup(point.data(), 0);
        }
        return ordering;
    }
};

double since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 5) return 2;
    const int rounds = std::atoi(argv[1]), covariances = std::atoi(argv[4]);
    std::ios::sync_with_stdio(false);
    Network network;
    network.read();
    double best = std::numeric_limits<double>::infinity(), cost = 0.0;
    std::string solver, steps;
    for (int round = 0; round < 2 * rounds; ++round) {
        ceres::Solver::Options options;
        options.linear_solver_type = round % 2 == 0 ? ceres::DENSE_SCHUR : ceres::SPARSE_SCHUR;
        options.linear_solver_ordering.reset(network.order());
        options.num_threads = 1;
        options.logging_type = ceres::SILENT;
        options.max_num_iterations = 200;
        options.function_tolerance = std::atof(argv[2]);
        options.initial_trust_region_radius = std::atof(argv[3]);
        options.parameter_tolerance = 1e-16;
        options.gradient_tolerance = 1e-16;
        network.reset();
        ceres::Solver::Summary summary;
        const auto clock = std::chrono::steady_clock::now();
        ceres::Solve(options, &network.problem, &summary);
        const double seconds = since(clock);
        if (summary.termination_type != ceres::CONVERGENCE) {
            std::cerr << summary.BriefReport() << "\n";
            return 1;
        }
        if (seconds < best) {
            best = seconds;
            cost = 2.0 * summary.final_cost;
            solver = ceres::LinearSolverTypeToString(options.linear_solver_type);
            steps = std::to_string(summary.num_successful_steps);
        }
    }
    double covariance_seconds = -1.0, interior[81] = {};
    for (int round = 0; round < covariances; ++round) {
        std::vector<std::pair<const double*, const double*>> blocks{{network.now.camera.data(), network.now.camera.data()}};
        for (const Pose& pose : network.now.poses) blocks.emplace_back(pose.data(), pose.data());
        ceres::Covariance::Options options;
        options.num_threads = 1;
        ceres::Covariance covariance(options);
        const auto clock = std::chrono::steady_clock::now();
        if (!covariance.Compute(blocks, &network.problem)) return 1;
        const double seconds = since(clock);
        covariance.GetCovarianceBlock(network.now.camera.data(), network.now.camera.data(), interior);
        covariance_seconds = round == 0 ? seconds : std::min(covariance_seconds, seconds);
    }
    std::cout.precision(17);
    std::cout << best << ' ' << solver << ' ' << steps << ' ' << cost;
    for (double value : network.now.camera) std::cout << ' ' << value;
    for (int i = 0; i < 9; ++i) std::cout << ' ' << std::sqrt(interior[10 * i]);
    std::cout << ' ' << covariance_seconds << '\n';
    return 0;
}
