/// \file A common interface to FFTW's two libraries, and cached groups of plans. Private to
/// engine/fourier.
#pragma once

#include <atomic>
#include <complex>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fftw3.h>

namespace touchtrial::engine {

/// The functions of FFTW's two libraries, by precision.
template <typename Real>
struct Fftw;

template <>
struct Fftw<double> {
  using Complex = fftw_complex;
  using Plan = fftw_plan;
  static constexpr auto* plan_real_forward = &fftw_plan_dft_r2c_2d;
  static constexpr auto* plan_real_inverse = &fftw_plan_dft_c2r_2d;
  static constexpr auto* plan_many = &fftw_plan_many_dft;
  static constexpr auto* real_forward = &fftw_execute_dft_r2c;
  static constexpr auto* real_inverse = &fftw_execute_dft_c2r;
  static constexpr auto* transform = &fftw_execute_dft;
  static constexpr auto* destroy = &fftw_destroy_plan;
  static constexpr auto* forget = &fftw_forget_wisdom;
};

template <>
struct Fftw<float> {
  using Complex = fftwf_complex;
  using Plan = fftwf_plan;
  static constexpr auto* plan_real_forward = &fftwf_plan_dft_r2c_2d;
  static constexpr auto* plan_real_inverse = &fftwf_plan_dft_c2r_2d;
  static constexpr auto* plan_many = &fftwf_plan_many_dft;
  static constexpr auto* real_forward = &fftwf_execute_dft_r2c;
  static constexpr auto* real_inverse = &fftwf_execute_dft_c2r;
  static constexpr auto* transform = &fftwf_execute_dft;
  static constexpr auto* destroy = &fftwf_destroy_plan;
  static constexpr auto* forget = &fftwf_forget_wisdom;
};

/// Measured plans would be up to a third faster, but they differ between runs and would change the
/// last bits of a texture.
inline constexpr unsigned kPlannerFlags = FFTW_ESTIMATE;

/// FFTW's planner has global state: only the execution of a plan is thread-safe.
inline std::mutex& planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Whether FFTW has run out of memory. Its planner is then inconsistent and must not be used.
inline std::atomic<bool>& out_of_memory_flag() {
  static std::atomic<bool> flag{false};
  return flag;
}

/// Memory aligned to a cache line, as all plans expect. Uninitialised.
template <typename Element>
class FftwBuffer {
 public:
  explicit FftwBuffer(std::size_t size)
      : size_(size),
        elements_(static_cast<Element*>(::operator new(size * sizeof(Element), kAlignment))) {}
  ~FftwBuffer() { ::operator delete(elements_, kAlignment); }
  FftwBuffer(const FftwBuffer&) = delete;
  FftwBuffer& operator=(const FftwBuffer&) = delete;

  [[nodiscard]] Element* data() const noexcept { return elements_; }
  [[nodiscard]] std::span<Element> span() const noexcept { return {elements_, size_}; }

 private:
  static constexpr std::align_val_t kAlignment{64};

  std::size_t size_;
  Element* elements_;
};

/// std::complex<Real> is laid out as FFTW's pair of reals (C++ standard, [complex.numbers]).
template <typename Real>
[[nodiscard]] typename Fftw<Real>::Complex* as_fftw(std::complex<Real>* numbers) noexcept {
  return reinterpret_cast<typename Fftw<Real>::Complex*>(numbers);
}

/// A group of plans, which can be used with any FftwBuffer. Creating a plan of up to 4096 samples
/// takes longer than executing it, so these plans are cached: TextureSense, for instance, is
/// created for each exploration.
template <typename Real>
class FftwPlans {
 public:
  using Plan = typename Fftw<Real>::Plan;
  /// Makes all plans with kPlannerFlags; nullptr where FFTW has none.
  using Make = std::function<std::vector<Plan>()>;

  /// \param name  unique within this precision
  /// \param samples  number of samples transformed
  /// \throws std::bad_alloc if FFTW is or was out of memory
  /// \throws std::invalid_argument if FFTW has no such plan
  FftwPlans(const std::string& name, std::size_t samples, const Make& make) {
    const std::lock_guard lock(planner_mutex());
    const bool use_cache = samples <= kMaxCachedSamples;
    if (use_cache) plans_ = cache()[name];
    if (plans_) return;
    if (out_of_memory_flag()) throw std::bad_alloc();
    plans_ = std::make_shared<Plans>(make());
    // If FFTW kept its wisdom, plans would depend on the order in which transforms are created.
    Fftw<Real>::forget();
    if (!plans_->are_complete()) {
      plans_.reset();
      throw std::invalid_argument("no Fourier transform for this size of plane");
    }
    if (use_cache) cache()[name] = plans_;
  }
  ~FftwPlans() {
    const std::lock_guard lock(planner_mutex());
    plans_.reset();
  }
  FftwPlans(const FftwPlans&) = delete;
  FftwPlans& operator=(const FftwPlans&) = delete;

  [[nodiscard]] Plan operator[](std::size_t index) const noexcept { return plans_->handles[index]; }

 private:
  static constexpr std::size_t kMaxCachedSamples = 4096;

  struct Plans {
    explicit Plans(std::vector<Plan> plans) : handles(std::move(plans)) {}
    ~Plans() {
      for (const Plan plan : handles) Fftw<Real>::destroy(plan);
    }
    Plans(const Plans&) = delete;
    Plans& operator=(const Plans&) = delete;

    [[nodiscard]] bool are_complete() const {
      for (const Plan plan : handles) {
        if (plan == nullptr) return false;
      }
      return true;
    }

    std::vector<Plan> handles;
  };

  static std::map<std::string, std::shared_ptr<Plans>>& cache() {
    static std::map<std::string, std::shared_ptr<Plans>> plans;
    return plans;
  }

  std::shared_ptr<Plans> plans_;  // guarded by planner_mutex()
};

}  // namespace touchtrial::engine
