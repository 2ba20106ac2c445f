// SPDX-License-Identifier: GPL-3.0-or-later
// Own factorizations beside CHOLMOD's and Eigen's, on the systems of the Newton steps of flatten_best().
#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#ifdef PAPILLA_HAVE_CHOLMOD
#include <Eigen/CholmodSupport>
#endif

#include <cmath>
#include <memory>
#include <optional>

#include "bench/param_targets.hpp"
#include "dense_cholesky.hpp"
#include "map_descent.hpp"
#include "sparse_cholesky.hpp"

namespace papilla::bench {
namespace {

using namespace param_detail;

using SparseMatrix = Eigen::SparseMatrix<double>;

/// H d = -g of the symmetric Dirichlet energy, two unknowns a vertex, where the disk is projected along z.
class NewtonSystem {
 public:
  explicit NewtonSystem(const TriangleMesh& disk)
      : disk_(disk), rest_(rest_shapes(disk.positions, disk.triangles)), energy_(rest_) {
    for (const Vec3& p : disk.positions) uv_.push_back({p.x, p.y});
    right_.resize(static_cast<Eigen::Index>(2 * uv_.size()));
    const std::vector<Vec2> gradient = energy_gradient({disk_.triangles, &energy_}, uv_);
    for (std::size_t v = 0; v < uv_.size(); ++v) {
      const auto row = static_cast<Eigen::Index>(2 * v);
      right_[row] = -gradient[v].x, right_[row + 1] = -gradient[v].y;
    }
  }

  void fill(std::size_t t, double* matrix) const {
    constexpr double anchor = 1e-8;  // as in the descent: translations and rotations change no energy
    const auto [a, b, c] = disk_.triangles[t];
    energy_.hessian(t, uv_[a], uv_[b], uv_[c], 1, matrix);
    for (std::size_t k = 0; k < 6; ++k) matrix[7 * k] += anchor;
  }

  /// The lower half.
  SparseMatrix matrix() const {
    std::vector<Eigen::Triplet<double, int>> entries;
    entries.reserve(21 * disk_.triangles.size());
    CornerHessian h;
    for (std::size_t t = 0; t < disk_.triangles.size(); ++t) {
      fill(t, h.data());
      for (std::size_t j = 0; j < 6; ++j)
        for (std::size_t i = j; i < 6; ++i) {
          const auto row = static_cast<int>(2 * disk_.triangles[t][i / 2] + i % 2);
          const auto column = static_cast<int>(2 * disk_.triangles[t][j / 2] + j % 2);
          entries.emplace_back(std::max(row, column), std::min(row, column), h[6 * j + i]);
        }
    }
    SparseMatrix matrix(right_.size(), right_.size());
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }

  const Eigen::VectorXd& right() const { return right_; }
  const std::vector<Vec2>& uv() const { return uv_; }
  const TriangleMesh& disk() const { return disk_; }

 private:
  const TriangleMesh& disk_;
  std::vector<RestShape> rest_;
  SymmetricDirichlet energy_;
  std::vector<Vec2> uv_;
  Eigen::VectorXd right_;
};

struct System {
  explicit System(const Disk& disk) : name(disk.name), newton(disk.mesh), matrix(newton.matrix()) {}
  std::string name;
  NewtonSystem newton;
  SparseMatrix matrix;
};

/// A solver of one system, in steps.
class Factorization {
 public:
  virtual ~Factorization() = default;
  virtual void analyse(const System& system) = 0;
  virtual void factor(const System& system) = 0;
  virtual void solve(Eigen::VectorXd& x) = 0;  ///< Overwrites the right side.
  virtual double entries() = 0;                ///< How many numbers the factor has.
};

/// Fills in the Hessians of the triangles while it factors, as the descent does.
class Own final : public Factorization {
 public:
  void analyse(const System& system) override {
    elements_ = elements_of(system.newton.disk().triangles);
    for (const Vec2 p : system.newton.uv()) where_.push_back({p.x, p.y, 0});
    factor_.emplace(elements_, where_, 2);
  }
  void factor(const System& system) override {
    factor_->factor([&](std::size_t t, double* matrix) { system.newton.fill(t, matrix); });
  }
  void solve(Eigen::VectorXd& x) override { factor_->solve({x.data(), static_cast<std::size_t>(x.size())}); }
  double entries() override {
    constexpr Index leaf = 24;  // as in the factorization
    double count = 0;
    for (const Front& front : dissect(elements_, where_, leaf).fronts) {
      const double own = 2.0 * front.own(), rows = 2.0 * static_cast<double>(front.rows.size());
      count += own * (own + 1) / 2 + own * rows;
    }
    return count;
  }

 private:
  Elements elements_;
  std::vector<Vec3> where_;
  std::optional<SparseCholesky<double>> factor_;
};

template <class Solver>
class EigenSolver : public Factorization {
 public:
  void analyse(const System& system) override { solver_.analyzePattern(system.matrix); }
  void factor(const System& system) override { solver_.factorize(system.matrix); }
  void solve(Eigen::VectorXd& x) override { x = solver_.solve(x).eval(); }

 protected:
  Solver solver_;
};

class EigenPeer final : public EigenSolver<Eigen::SimplicialLDLT<SparseMatrix>> {
 public:
  double entries() override { return static_cast<double>(solver_.matrixL().nestedExpression().nonZeros()); }
};

#ifdef PAPILLA_HAVE_CHOLMOD
class CholmodPeer final : public EigenSolver<Eigen::CholmodSupernodalLLT<SparseMatrix>> {
 public:
  explicit CholmodPeer(int ordering) {
    solver_.cholmod().nmethods = 1;
    solver_.cholmod().method[0].ordering = ordering;
  }
  double entries() override { return solver_.cholmod().lnz; }
};
#endif

/// Times one factorization and one solution; the order of elimination is found before.
void add_solver(const std::shared_ptr<const System>& system, const std::string& name,
                const std::function<std::unique_ptr<Factorization>()>& make, BenchReport& report) {
  report.add({.method = "newton step", .solver = name, .input = system->name}, [=](Recorder& recorder) {
    const std::unique_ptr<Factorization> solver = make();
    const Stopwatch clock;
    solver->analyse(*system);
    recorder.record("analyse_seconds", clock.seconds());
    Eigen::VectorXd x = system->newton.right();
    const double begin = clock.seconds();
    double factored = 0;
    recorder.time([&] {
      solver->factor(*system);
      factored = clock.seconds();
      solver->solve(x);
    });
    recorder.record("factor_seconds", factored - begin);
    recorder.record("solve_seconds", clock.seconds() - factored);
    recorder.record("factor_entries", solver->entries());
    const Eigen::VectorXd left = system->matrix.selfadjointView<Eigen::Lower>() * x;
    recorder.record("residual", (left - system->newton.right()).norm() / system->newton.right().norm());
  });
}

void add_dense(int size, BenchReport& report) {
  const auto matrix = std::make_shared<Eigen::MatrixXd>(Eigen::MatrixXd::Random(size, size));
  *matrix = *matrix * matrix->transpose() + size * Eigen::MatrixXd::Identity(size, size);
  const std::string input = "dense " + std::to_string(size);
  report.add({.method = "dense", .solver = "own", .input = input}, [=](Recorder& recorder) {
    const auto rows = static_cast<std::size_t>(size);
    std::vector<double> a(matrix->data(), matrix->data() + matrix->size());
    a.resize(a.size() + k_dense_slack);
    recorder.time([&] { keep(factor_columns(a.data(), rows, rows)); });
  });
  report.add({.method = "dense", .solver = "eigen", .input = input}, [=](Recorder& recorder) {
    Eigen::LLT<Eigen::MatrixXd> factor(size);
    recorder.time([&] { factor.compute(*matrix); });
  });
}

}  // namespace

void add_factorizations(const std::vector<Disk>& all, BenchReport& report) {
  for (const Disk& disk : all) {
    if (!disk.name.starts_with("dash")) continue;
    const auto system = std::make_shared<const System>(disk);
    add_solver(
        system, "own", [] { return std::make_unique<Own>(); }, report);
#ifdef PAPILLA_HAVE_CHOLMOD
    add_solver(
        system, "cholmod, metis", [] { return std::make_unique<CholmodPeer>(CHOLMOD_METIS); }, report);
    add_solver(
        system, "cholmod, amd", [] { return std::make_unique<CholmodPeer>(CHOLMOD_AMD); }, report);
#endif
    if (disk.size != Disk::huge)
      add_solver(
          system, "eigen, amd", [] { return std::make_unique<EigenPeer>(); }, report);
  }
  for (const int size : report.options().quick ? std::vector<int>{100} : std::vector<int>{100, 400, 1600})
    add_dense(size, report);
#ifdef PAPILLA_HAVE_CHOLMOD
  for (const char* quantity : {"seconds", "cpu_seconds", "analyse_seconds"}) {
    report.compare("newton step/own", "newton step/cholmod, metis", quantity);
    report.compare("newton step/own", "newton step/cholmod, amd", quantity);
  }
#endif
  report.compare("newton step/own", "newton step/eigen, amd");
  report.compare("dense/own", "dense/eigen");
}

}  // namespace papilla::bench
