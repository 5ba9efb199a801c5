#include "analysis/exports/bids/export_bids.hpp"
#include "analysis/exports/csv_reading.hpp"
#include "analysis/exports/export_psych_ds.hpp"
#include "analysis/exports/export_tables.hpp"
#include "analysis/fake_study.hpp"
#include "protocols/identification/analysis/mixed_model.hpp"
#include "support/catch.hpp"

#include <clocale>
#include <locale>
#include <sstream>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;

/// A decimal comma and points between thousands, as in German.
class CommaPunctuation final : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

/// The program's locale, C++'s and (where one with a comma is installed) C's, until the end.
class CommaLocale {
 public:
  CommaLocale() : before_(std::locale::global(std::locale(std::locale(), new CommaPunctuation))) {
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"}) {
      if (std::setlocale(LC_NUMERIC, name) != nullptr) break;
    }
  }
  ~CommaLocale() {
    std::locale::global(before_);
    std::setlocale(LC_NUMERIC, "C");
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

 private:
  std::locale before_;
};

void export_everything(FakeStudy& study, const fs::path& out) {
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  const analysis::DatasetSource source{study.store(), &outcomes, &study.key()};
  analysis::export_csv(study.store(), outcomes, out / "csv");
  analysis::export_json(study.store(), outcomes, out / "json");
  analysis::export_bids(source, {.traces = true}, out / "bids");
  analysis::export_psych_ds(source, {}, out / "psych");
  analysis::export_r_model(study.store(), outcomes, out / "r");
}

}  // namespace

TEST_CASE("Exports are the same bytes under a locale with a decimal comma") {
  FakeStudy study(study::identification::comparison());
  for (int i = 1; i <= 3; ++i) {
    study.add({.participant = "P0" + std::to_string(i),
               .enrolment = i,
               .answers = FakeStudy::confusing(0, i % 3)});
  }
  study.close_and_unblind();
  export_everything(study, study.folder() / "plain");
  {
    const CommaLocale comma;
    std::ostringstream probe;
    probe << 1234.5;
    REQUIRE(probe.str() == "1.234,5");
    export_everything(study, study.folder() / "comma");
  }
  int compared = 0;
  for (const auto& entry : fs::recursive_directory_iterator(study.folder() / "plain")) {
    if (!entry.is_regular_file()) continue;
    const fs::path name = entry.path().lexically_relative(study.folder() / "plain");
    INFO(name);
    CHECK(text_of_file(entry.path()) == text_of_file(study.folder() / "comma" / name));
    ++compared;
  }
  CHECK(compared > 150);
}

}  // namespace touchtrial
