#include "engine/fourier/planning.hpp"

#include "core/files.hpp"
#include "core/random.hpp"
#include "engine/fourier/real_fft.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <complex>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;

/// Uses measured plans in a folder during its lifetime.
class MeasuredPlans {
 public:
  explicit MeasuredPlans(const fs::path& folder, std::size_t fewest_samples = 1) {
    engine::use_measured_plans(folder, fewest_samples);
  }
  ~MeasuredPlans() { engine::use_measured_plans({}); }
  MeasuredPlans(const MeasuredPlans&) = delete;
  MeasuredPlans& operator=(const MeasuredPlans&) = delete;
};

std::vector<std::complex<double>> spectrum_of_noise() {
  engine::RealFft<double> fft(30, 28, engine::FftPlan::measured);
  RandomStream random(5, "planning test");
  for (double& sample : fft.plane()) sample = random.uniform(-1.0, 1.0);
  fft.forward();
  return {fft.spectrum().begin(), fft.spectrum().end()};
}

std::vector<fs::path> wisdom_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".wisdom") files.push_back(entry.path());
  }
  return files;
}

double largest_difference_of(const std::vector<std::complex<double>>& a,
                             const std::vector<std::complex<double>>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

TEST_CASE("a measured plan transforms like an estimated one, and is kept") {
  const TempFolder folder;
  const auto estimated = spectrum_of_noise();
  const fs::path cache = folder.path() / "deep" / "cache";
  const MeasuredPlans measured(cache);
  CHECK(largest_difference_of(spectrum_of_noise(), estimated) < 1e-12);
  REQUIRE(wisdom_in(cache).size() == 1);
  const std::string name = wisdom_in(cache).front().filename().string();
  CHECK(name.find("f64-30x28") != std::string::npos);
  CHECK(fs::file_size(wisdom_in(cache).front()) > 0);
}

TEST_CASE("a kept plan gives the same bits in the next run") {
  const TempFolder folder;
  std::vector<std::complex<double>> first;
  {
    const MeasuredPlans measured(folder.path());
    first = spectrum_of_noise();
  }
  const Bytes kept = read_file(wisdom_in(folder.path()).at(0));
  const MeasuredPlans again(folder.path());
  CHECK(spectrum_of_noise() == first);
  CHECK(read_file(wisdom_in(folder.path()).at(0)) == kept);
}

TEST_CASE("a kept plan that cannot be read is measured anew") {
  const TempFolder folder;
  const auto estimated = spectrum_of_noise();
  {
    const MeasuredPlans measured(folder.path());
    (void)spectrum_of_noise();
  }
  const fs::path file = wisdom_in(folder.path()).at(0);
  for (const char* content : {"", "(fftw", "not wisdom at all", "(fftw-3.3.10 fftw_wisdom)"}) {
    replace_file(file, std::string_view(content));
    const MeasuredPlans measured(folder.path());
    CHECK(largest_difference_of(spectrum_of_noise(), estimated) < 1e-12);
    CHECK(fs::file_size(file) > 40);
  }
}

TEST_CASE("a plan that cannot be kept is estimated") {
  const TempFolder folder;
  const auto estimated = spectrum_of_noise();
  const fs::path file = folder.path() / "a file";
  replace_file(file, std::string_view("x"));
  for (const fs::path& cache : {file / "cache", fs::path()}) {
    const MeasuredPlans measured(cache);
    CHECK(spectrum_of_noise() == estimated);
  }
}

/// Sets an environment variable during its lifetime.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* former = std::getenv(name); former != nullptr) former_ = former;
    set(value);
  }
  ~Variable() { set(former_ ? former_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void set(const char* value) {
    if (value == nullptr) {
      ::unsetenv(name_);
    } else {
      ::setenv(name_, value, 1);
    }
  }

  const char* name_;
  std::optional<std::string> former_;
};

TEST_CASE("the cache folder is the user's, or empty") {
  const Variable home("HOME", "/somebody");
  const Variable cache("XDG_CACHE_HOME", "/elsewhere");
  CHECK(engine::user_cache_folder() == "/elsewhere/touchtrial");
  const Variable relative("XDG_CACHE_HOME", "here");
  CHECK(engine::user_cache_folder() == "/somebody/.cache/touchtrial");
  const Variable homeless("HOME", nullptr);
  CHECK(engine::user_cache_folder().empty());
}

TEST_CASE("small transforms are not measured, and measured plans do not affect estimated ones") {
  const TempFolder folder;
  const auto estimated = spectrum_of_noise();
  const MeasuredPlans measured(folder.path(), 2000);
  const engine::RealFft<double> larger(60, 56, engine::FftPlan::measured);
  const engine::RealFft<double> once(64, 70);
  CHECK(wisdom_in(folder.path()).size() == 1);
  CHECK(spectrum_of_noise() == estimated);
  CHECK(wisdom_in(folder.path()).size() == 1);
}

}  // namespace
}  // namespace touchtrial
