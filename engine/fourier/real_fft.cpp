#include "engine/fourier/real_fft.hpp"

#include "engine/fourier/planning.hpp"

#include <cstddef>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include <fftw3.h>

namespace touchtrial::engine {
namespace {

/// The functions of FFTW's two libraries, by precision.
template <typename Real>
struct Fftw;

template <>
struct Fftw<double> {
  using Complex = fftw_complex;
  using Plan = fftw_plan;
  static constexpr auto* allocate = &fftw_malloc;
  static constexpr auto* release = &fftw_free;
  static constexpr auto* plan_forward = &fftw_plan_dft_r2c_2d;
  static constexpr auto* plan_inverse = &fftw_plan_dft_c2r_2d;
  static constexpr auto* forward = &fftw_execute_dft_r2c;
  static constexpr auto* inverse = &fftw_execute_dft_c2r;
  static constexpr auto* destroy = &fftw_destroy_plan;
  static constexpr auto* forget = &fftw_forget_wisdom;
  static constexpr auto* learned = &fftw_export_wisdom_to_string;
  static constexpr auto* import = &fftw_import_wisdom_from_string;
  static std::string version() { return fftw_version; }
  static constexpr const char* kPrecision = "f64";
};

template <>
struct Fftw<float> {
  using Complex = fftwf_complex;
  using Plan = fftwf_plan;
  static constexpr auto* allocate = &fftwf_malloc;
  static constexpr auto* release = &fftwf_free;
  static constexpr auto* plan_forward = &fftwf_plan_dft_r2c_2d;
  static constexpr auto* plan_inverse = &fftwf_plan_dft_c2r_2d;
  static constexpr auto* forward = &fftwf_execute_dft_r2c;
  static constexpr auto* inverse = &fftwf_execute_dft_c2r;
  static constexpr auto* destroy = &fftwf_destroy_plan;
  static constexpr auto* forget = &fftwf_forget_wisdom;
  static constexpr auto* learned = &fftwf_export_wisdom_to_string;
  static constexpr auto* import = &fftwf_import_wisdom_from_string;
  static std::string version() { return fftwf_version; }
  static constexpr const char* kPrecision = "f32";
};

/// FFTW's planner has global state: only the execution of a plan is thread-safe.
std::mutex& planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// The two plans of a size, for any buffers of FftwBuffer; nullptr if FFTW has none. Create and
/// destroy them under the planner's mutex.
template <typename Real>
struct Plans {
  using Plan = typename Fftw<Real>::Plan;

  Plans(Plan there, Plan back) : forward(there), inverse(back) {}
  ~Plans() {
    Fftw<Real>::destroy(forward);
    Fftw<Real>::destroy(inverse);
  }
  Plans(const Plans&) = delete;
  Plans& operator=(const Plans&) = delete;

  Plan forward;
  Plan inverse;
};

/// Transforms up to this size are quicker than their planning, so their estimated plans are kept
/// for reuse: a new sense of touch, for instance, is created for every exploration.
constexpr std::size_t kKeptUpToSamples = 4096;

/// The kept plan of a size. Use it under the planner's mutex.
template <typename Real>
std::shared_ptr<Plans<Real>>& kept_plans(int height, int width) {
  static std::map<std::pair<int, int>, std::shared_ptr<Plans<Real>>> kept;
  return kept[{height, width}];
}

/// Memory with the alignment that FFTW's plans need.
template <typename Real, typename Element>
class FftwBuffer {
 public:
  explicit FftwBuffer(std::size_t size)
      : size_(size),
        elements_(static_cast<Element*>(Fftw<Real>::allocate(size * sizeof(Element)))) {
    if (elements_ == nullptr) throw std::bad_alloc();
  }
  ~FftwBuffer() { Fftw<Real>::release(elements_); }
  FftwBuffer(const FftwBuffer&) = delete;
  FftwBuffer& operator=(const FftwBuffer&) = delete;

  [[nodiscard]] Element* data() const noexcept { return elements_; }
  [[nodiscard]] std::span<Element> span() const noexcept { return {elements_, size_}; }

 private:
  std::size_t size_;
  Element* elements_;
};

}  // namespace

template <typename Real>
struct RealFft<Real>::State {
  State(int height, int width, FftPlan way)
      : height_(height),
        width_(width),
        plane(static_cast<std::size_t>(height) * static_cast<std::size_t>(width)),
        spectrum(static_cast<std::size_t>(height) * static_cast<std::size_t>(width / 2 + 1)) {
    const std::lock_guard lock(planner_mutex());
    const bool keep = way == FftPlan::estimated && plane.span().size() <= kKeptUpToSamples;
    if (keep) plans = kept_plans<Real>(height, width);
    if (plans) return;
    Fftw<Real>::forget();
    if (way == FftPlan::estimated || !plan_by_file()) plan(FFTW_ESTIMATE);
    // Otherwise plans would depend on the order in which transforms are created.
    Fftw<Real>::forget();
    if (keep) kept_plans<Real>(height, width) = plans;
  }
  ~State() {
    const std::lock_guard lock(planner_mutex());
    plans.reset();
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  [[nodiscard]] bool is_planned() const {
    return plans->forward != nullptr && plans->inverse != nullptr;
  }
  /// std::complex<Real> is laid out as FFTW's pair of reals (C++ standard, [complex.numbers]).
  [[nodiscard]] typename Fftw<Real>::Complex* coefficients() const {
    return reinterpret_cast<typename Fftw<Real>::Complex*>(spectrum.data());
  }

 private:
  int height_, width_;

  [[nodiscard]] std::string file_name() const {
    return as_file_name(Fftw<Real>::version() + '-' + Fftw<Real>::kPrecision + '-' +
                        std::to_string(height_) + 'x' + std::to_string(width_) + '-' +
                        processor_name() + ".wisdom");
  }

  bool plan_by_file() {
    const auto text = wisdom_files().text_for(
        file_name(), plane.span().size(),
        [this](const std::string& wisdom) { return fits(wisdom); }, [this] { return learned(); });
    if (text && fits(*text)) return true;
    Fftw<Real>::forget();
    return false;
  }

  void plan(unsigned flags) {
    plans = std::make_shared<Plans<Real>>(
        Fftw<Real>::plan_forward(height_, width_, plane.data(), coefficients(), flags),
        Fftw<Real>::plan_inverse(height_, width_, coefficients(), plane.data(), flags));
  }

  bool fits(const std::string& wisdom) {
    Fftw<Real>::forget();
    if (Fftw<Real>::import(wisdom.c_str()) == 0) return false;
    plan(FFTW_MEASURE | FFTW_WISDOM_ONLY);
    return is_planned();
  }

  std::string learned() {
    Fftw<Real>::forget();
    plan(FFTW_MEASURE);
    const std::unique_ptr<char, decltype(&std::free)> text(Fftw<Real>::learned(), &std::free);
    return text == nullptr ? std::string() : std::string(text.get());
  }

 public:
  FftwBuffer<Real, Real> plane;
  FftwBuffer<Real, std::complex<Real>> spectrum;
  std::shared_ptr<Plans<Real>> plans;
};

template <typename Real>
RealFft<Real>::RealFft(int height, int width, FftPlan plan)
    : state_(std::make_unique<State>(height, width, plan)) {
  if (!state_->is_planned()) {
    throw std::invalid_argument("no Fourier transform for this size of plane");
  }
}

template <typename Real>
RealFft<Real>::~RealFft() = default;

template <typename Real>
std::span<Real> RealFft<Real>::plane() noexcept {
  return state_->plane.span();
}

template <typename Real>
std::span<std::complex<Real>> RealFft<Real>::spectrum() noexcept {
  return state_->spectrum.span();
}

template <typename Real>
void RealFft<Real>::forward() noexcept {
  Fftw<Real>::forward(state_->plans->forward, state_->plane.data(), state_->coefficients());
}

template <typename Real>
void RealFft<Real>::inverse() noexcept {
  Fftw<Real>::inverse(state_->plans->inverse, state_->coefficients(), state_->plane.data());
}

template class RealFft<float>;
template class RealFft<double>;

}  // namespace touchtrial::engine
