#include "analysis/report/figures/gnuplot.hpp"

#include "analysis/report/figures/figure.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"
#include "support/temp_folder.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

using namespace touchtrial;
using namespace touchtrial::analysis;

namespace {

/// A variable of the environment, as it was again at the end.
class Variable {
 public:
  Variable(const char* name, const std::string& value)
      : name_(name), before_(std::getenv(name) == nullptr ? "" : std::getenv(name)) {
    ::setenv(name_, value.c_str(), 1);
  }
  ~Variable() {
    if (before_.empty()) {
      ::unsetenv(name_);
    } else {
      ::setenv(name_, before_.c_str(), 1);
    }
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
  [[nodiscard]] const std::string& before() const { return before_; }

 private:
  const char* name_;
  std::string before_;
};

/// What gnuplot prints on its terminal of letters.
std::string printed_by(const std::string& script) {
  return GnuplotProcess("", "set terminal dumb 40 10\n" + script).result();
}

/// What is said when a program of that name stands for gnuplot.
/// \param script  of a shell
std::string complaint_about(const std::string& script) {
  const TempFolder folder;
  const auto program = folder.path() / "gnuplot";
  replace_file(program, "#!/bin/sh\n" + script + "\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const Variable path("PATH", folder.path().string() + ":/usr/bin:/bin");
  const Figure figure{.id = "x", .caption = {}, .alt = {}};
  return message_of<Error>([&] { return draw_figure(figure, FigureFormat::svg); });
}

}  // namespace

TEST_CASE("a script that gnuplot refuses is named in one line") {
  CHECK_THROWS_WITH(printed_by("plot nonsense(\n"), names("gnuplot"));
  CHECK_THROWS_WITH(printed_by("plot nonsense(\n"), !holds_text("\n"));
}

TEST_CASE("a text becomes one gnuplot string whatever is in it") {
  CHECK(gnuplot_string("it's") == "'it''s'");
  CHECK(gnuplot_string("two\nlines") == "'two lines'");
  CHECK(gnuplot_string("") == "''");
}

TEST_CASE("an older gnuplot is told from one that fails for another reason") {
  const std::string version = "[ \"$2\" = --version ] && { echo gnuplot ";
  const std::string end = " patchlevel 1; exit 0; }\n";
  CHECK_THAT(complaint_about(version + "5.0" + end + "echo 'unknown option' >&2; exit 1"),
             names("5.0 5.2") && holds_text("unknown option"));
  for (const std::string newer : {"5.4", "6.0", "10.1"}) {
    const std::string said = complaint_about(version + newer + end + "echo oh >&2; exit 1");
    CHECK_THAT(said, names("oh"));
    CHECK_THAT(said, !names("5.2"));
  }
  CHECK_THAT(complaint_about(version + "5.4" + end + "exit 0"), names("gnuplot"));
  CHECK_THAT(complaint_about("kill -9 $$"), names("Killed"));
}

TEST_CASE("gnuplot's temporary files lie where TMPDIR says") {
  const TempFolder folder;
  {
    const Variable nowhere("TMPDIR", (folder.path() / "nowhere").string());
    CHECK_THROWS_WITH(printed_by("plot x\n"), names("TMPDIR"));
  }
  const Variable own("TMPDIR", folder.path().string());
  CHECK_THAT(printed_by("plot x\n"), holds_text("*"));
}
