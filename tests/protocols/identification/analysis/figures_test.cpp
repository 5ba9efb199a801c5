#include "protocols/identification/analysis/figures/figures.hpp"

#include "analysis/report/figures/gnuplot_script.hpp"
#include "analysis/report/figures/redraw.hpp"
#include "analysis/text_matching.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/identification/analysis/fake_report.hpp"
#include "protocols/identification/analysis/page/sections.hpp"
#include "support/catch.hpp"
#include "support/refusal.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <set>

using namespace touchtrial;
using namespace touchtrial::analysis;
using namespace touchtrial::analysis::identification;

namespace {

const Figure& figure_of(const std::vector<Figure>& figures, const std::string& id) {
  const auto found = std::find_if(figures.begin(), figures.end(),
                                  [&id](const Figure& figure) { return figure.id == id; });
  REQUIRE(found != figures.end());
  return *found;
}

std::string script_of(const Figure& figure) {
  return gnuplot_script(figure, layout_of(figure));
}

/// What lies beside a figure.
std::string beside(const Figure& figure, const std::string& ending) {
  return redraw_files(figure).at(figure.id + ending);
}

std::string ids_of(const std::vector<Figure>& figures) {
  std::string ids;
  for (const Figure& figure : figures) ids += figure.id + ' ';
  return ids;
}

/// Every value of an attribute within tags, in order.
std::vector<std::string> attributes_of(const std::string& svg, const std::string& before) {
  std::vector<std::string> values;
  for (std::size_t at = svg.find(before); at != std::string::npos; at = svg.find(before, at + 1)) {
    const std::size_t begin = at + before.size();
    values.push_back(svg.substr(begin, svg.find(before.back(), begin) - begin));
  }
  return values;
}

/// Whether tags are closed in the order in which they are opened.
bool balanced(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1)) {
    const std::size_t end = xml.find('>', at);
    if (end == std::string::npos) return false;
    const std::string tag = xml.substr(at + 1, end - at - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" \n\t/", 1));
    if (tag.front() == '/') {
      if (open.empty() || "/" + open.back() != tag) return false;
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
    }
  }
  return open.empty();
}

/// Labels that would end a string, a data block or a tag, or run a command, if they were not
/// escaped.
std::vector<std::string> hostile_labels() {
  return {"it's; system 'touch /tmp/broken-out'",
          "back\\",
          "`touch /tmp/broken-out`",
          "two\nEOD\nlines",
          "$methods @macro %s %n 100%",
          "</text><script>alert(1)</script>&\"",
          "id='gpDot' url(#gpDot)",
          "Bürste 漢字 {/Symbol x}_2^3",
          std::string(300, 'w')};
}

class EmptyPath {
 public:
  EmptyPath() : before_(std::getenv("PATH")) { setenv("PATH", "/nonexistent", 1); }
  ~EmptyPath() { setenv("PATH", before_.c_str(), 1); }
  EmptyPath(const EmptyPath&) = delete;
  EmptyPath& operator=(const EmptyPath&) = delete;

 private:
  std::string before_;
};

}  // namespace

TEST_CASE("every figure stands on the page, below its section, but for the participants' flow") {
  for (const std::vector<std::string>& methods :
       {std::vector<std::string>{"adaptive"}, {"adaptive", "tv-gabor"}}) {
    const FakeReportOptions options{.methods = methods, .servo_trials = 50};
    const CueReport cues = fake_cues(options);
    const StudyReport report = fake_report(options);
    Pictures pictures;
    for (const Figure& figure : report_figures(report, {.cues = &cues})) {
      CHECK(figure.section.empty() == (figure.id == "participant-flow"));
      pictures.push_back({figure.id, figure.caption, figure.alt, "", figure.section});
    }
    std::size_t shown = 0;
    for (const Section& section : study_document(report, {}, pictures).sections) {
      for (const std::vector<Block>* blocks : {&section.blocks, &section.folded_blocks}) {
        for (const Block& block : *blocks) {
          const auto* picture = std::get_if<Picture>(&block);
          if (picture == nullptr) continue;
          ++shown;
          CHECK(picture->section == section.id);
        }
      }
    }
    CHECK(shown == pictures.size());
  }
}

TEST_CASE("figures of one method are those of a classification study") {
  FakeReportOptions options{.servo_trials = 50};
  const CueReport cues = fake_cues(options);
  const std::vector<Figure> figures = report_figures(fake_report(options), {.cues = &cues});
  CHECK(ids_of(figures) ==
        "confusion-and-accuracy accuracy-by-class accuracy-over-trials reaction-times "
        "ideal-observers servo-lateness ");
  for (const Figure& figure : figures) {
    CHECK(contains(script_of(figure), "'SIMULATED'"));
    CHECK(figure.caption.starts_with("SIMULATED participants: "));
    CHECK_FALSE(figure.alt.empty());
  }
}

TEST_CASE("figures of several methods hold them side by side, with participants' differences") {
  FakeReportOptions options{.methods = {"adaptive", "tv-gabor", "fixed"}};
  const StudyReport report = fake_report(options);
  const std::vector<Figure> figures = report_figures(report);
  CHECK(ids_of(figures) ==
        "methods-by-person methods confusions accuracy-over-trials reaction-times ");
  const Figure& people = figure_of(figures, "methods-by-person");
  CHECK(people.panels.at(1).x.names.size() == 3);
  CHECK(contains(people.alt, "adaptive − tv-gabor"));
  CHECK(contains(beside(people, ".csv"), "participants,2,"));
  CHECK(contains(beside(people, ".csv"), ",P1\n"));
}

TEST_CASE("figures of people have no stamp") {
  StudyReport report = fake_report();
  report.simulated = false;
  for (const Figure& figure : report_figures(report)) {
    CHECK_FALSE(contains(script_of(figure), "SIMULATED"));
    CHECK_FALSE(contains(figure.caption, "SIMULATED"));
  }
}

TEST_CASE("figures of a pilot or an interim look say so beside SIMULATED") {
  for (const Figure& figure : report_figures(fake_report(), {.stamp = "PILOT, INTERIM LOOK"})) {
    CHECK(contains(script_of(figure), "'PILOT, INTERIM LOOK'"));
    CHECK(contains(script_of(figure), "'SIMULATED'"));
    CHECK(figure.alt.starts_with("PILOT, INTERIM LOOK. "));
    CHECK(contains(draw_figure(figure, FigureFormat::svg), ">PILOT, INTERIM LOOK<"));
  }
}

TEST_CASE("figures hold the report's counts and intervals") {
  StudyReport report = fake_report();
  ClassAccuracy& bark = report.methods[0].accuracy[0];
  bark.accuracy = {25, 20};
  bark.wilson = wilson_interval(bark.accuracy);
  bark.mean = {4, 0.81, {0.7, 0.92}, 0.07};
  CHECK(contains(script_of(figure_of(report_figures(report), "accuracy-by-class")),
                 "\n1 81 70 92\n"));
  // Participants who do not differ have no interval that says something.
  bark.mean = {4, 0.8, {0.8, 0.8}, 0.0};
  const std::vector<Figure> figures = report_figures(report);
  CHECK(contains(script_of(figure_of(figures, "accuracy-by-class")), "\n1 80 60.869 91.1394\n"));
  CHECK(contains(figure_of(figures, "accuracy-by-class").alt,
                 "bark 80.0% (60.9 to 91.1%), 20 of 25"));
  const ConfusionMatrix& confusion = report.methods[0].confusion;
  CHECK(contains(beside(figure_of(figures, "confusion-and-accuracy"), ".csv"),
                 "4,4," + std::to_string(confusion.count(3, 3)) + "," +
                     std::to_string(confusion.presented(3)) + ","));
}

TEST_CASE("figures show the paper's values only on request, and only beside a class of that name") {
  const StudyReport report = fake_report();
  const auto data_of = [](const StudyReport& of, bool paper_values) {
    return beside(
        figure_of(report_figures(of, {.paper_values = paper_values}), "accuracy-by-class"), ".csv");
  };
  CHECK_FALSE(contains(data_of(report, false), "paper"));
  const std::string apart = data_of(report, true);
  CHECK(contains(apart, "\"paper (other images, other device)\",5.7,87,"));
  FakeReportOptions named{.classes = {"Image-2", "image_1", "x"}};
  const std::string beside_them = data_of(fake_report(named), true);
  CHECK(contains(beside_them, "2.25,87,"));
  CHECK(contains(beside_them, "1.25,72,"));
}

TEST_CASE(
    "a study in virtual time has no figure of the servo, and one without participants has none") {
  CHECK_FALSE(contains(ids_of(report_figures(fake_report())), "servo-lateness"));
  FakeReportOptions nobody{.participants = 0};
  CHECK(report_figures(fake_report(nobody)).empty());
  CHECK(report_figures(StudyReport{}).empty());
}

TEST_CASE("figures leave out values that are not finite") {
  StudyReport report = fake_report();
  report.methods[0].accuracy[1].mean = {};
  report.methods[0].accuracy[1].wilson.low = std::numeric_limits<double>::quiet_NaN();
  const Figure figure = figure_of(report_figures(report), "accuracy-by-class");
  CHECK_FALSE(contains(script_of(figure), "nan"));
  CHECK(balanced(draw_figure(figure, FigureFormat::svg)));
}

TEST_CASE("figures of one participant give no interval over participants") {
  FakeReportOptions options{.methods = {"adaptive", "tv-gabor"}, .participants = 1};
  const CueReport cues = fake_cues(options);
  for (const Figure& figure : report_figures(fake_report(options), {.cues = &cues})) {
    CHECK_FALSE(contains(figure.alt, "0.0 to 100.0%"));
    CHECK_FALSE(contains(figure.alt, "-100.0 to +100.0"));
  }
}

TEST_CASE("labels cannot break out of figures") {
  FakeReportOptions options{
      .classes = hostile_labels(), .methods = {"it's", "</svg>\nEOD"}, .participants = 2};
  const CueReport cues = fake_cues(options);
  StudyReport report = fake_report(options);
  report.collection.flow.enrolled = 3;
  report.collection.flow.excluded = 1;
  report.collection.flow.exclusion_reasons = {"it's\nEOD\n`x` </text>"};
  const std::vector<Figure> figures = report_figures(report, {.cues = &cues});
  for (const std::string& svg : draw_figures(figures, FigureFormat::svg)) {
    CHECK(balanced(svg));
    CHECK_FALSE(contains(svg, "<script"));
  }
  CHECK_FALSE(std::filesystem::exists("/tmp/broken-out"));
}

TEST_CASE("figures of an exploration show the path in contact, in newtons, over the texture") {
  ExplorationPath path;
  path.simulated = true;
  path.session = 3;
  path.trial = 7;
  path.class_label = "it's </text> bark";
  path.texture.geometry = {0.2, 20, 30};
  path.texture.grey = GreyImage(20, 30, 100);
  path.points = {
      {{9.0, 9.0}, {}, 0.0, false}, {{1.5, 2.5}, {}, 0.25, true}, {{2.0, 3.0}, {}, 0.5, true}};
  const std::vector<Figure> figures = report_figures(StudyReport{}, {.explorations = {&path, 1}});
  REQUIRE(ids_of(figures) == "exploration-3-7 ");
  const std::string script = script_of(figures[0]);
  CHECK(contains(script, " << EOD\n1.5 2.5 0.25\n2 3 0.5\nEOD\n"));
  CHECK(contains(script, "tangential force, N"));
  CHECK(contains(script, "'SIMULATED'"));
  CHECK(redraw_files(figures[0]).contains("exploration-3-7-1.png"));
  const std::string svg = draw_figure(figures[0], FigureFormat::svg);
  CHECK(balanced(svg));
  CHECK(contains(svg, "data:image/png;base64,"));
  path.points.clear();
  path.texture.grey = {};
  const std::vector<Figure> bare = report_figures(StudyReport{}, {.explorations = {&path, 1}});
  CHECK(balanced(draw_figure(bare[0], FigureFormat::svg)));
}

TEST_CASE("figures as SVG are described, stand alone, and share a page without sharing ids") {
  FakeReportOptions options{.servo_trials = 30};
  const CueReport cues = fake_cues(options);
  const std::vector<Figure> figures = report_figures(fake_report(options), {.cues = &cues});
  const std::vector<std::string> files = draw_figures(figures, FigureFormat::svg);
  std::set<std::string> ids;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string& svg = files[i];
    CHECK(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
    CHECK(balanced(svg));
    CHECK(contains(svg, "role=\"img\" aria-labelledby=\"" + figures[i].id + "-title " +
                            figures[i].id + "-desc\""));
    CHECK(contains(svg, "<title id=\"" + figures[i].id + "-title\">SIMULATED participants: "));
    CHECK_FALSE(contains(svg, "<title>"));
    std::set<std::string> own;
    for (const std::string& before : {std::string(" id=\""), std::string(" id='")}) {
      for (const std::string& id : attributes_of(svg, before)) {
        CHECK(own.insert(id).second);
        CHECK(ids.insert(id).second);
      }
    }
    for (const std::string& href : attributes_of(svg, "href='")) {
      CHECK((own.count(href.substr(1)) == 1 || href.starts_with("data:image/png;base64,")));
    }
  }
}

TEST_CASE("figures drawn one by one or together, at any time, are equal bytes") {
  const std::vector<Figure> figures = report_figures(fake_report());
  for (const FigureFormat format : {FigureFormat::svg, FigureFormat::pdf}) {
    const std::vector<std::string> files = draw_figures(figures, format);
    REQUIRE(files.size() == figures.size());
    // From 1.18 on cairo hides the time in a compressed part of the file.
    if (format == FigureFormat::pdf && !contains(files[1], "/CreationDate")) continue;
    CHECK(files[1] == draw_figure(figures[1], format));
    CHECK(files.back() == draw_figure(figures.back(), format));
  }
}

TEST_CASE("figures as PDF are PDF, without the time at which they were drawn") {
  const std::string pdf = draw_figure(report_figures(fake_report())[1], FigureFormat::pdf);
  CHECK(pdf.starts_with("%PDF-"));
  CHECK_FALSE(contains(pdf, "/CreationDate (D:20"));
}

TEST_CASE("figures of a large study stay small") {
  FakeReportOptions options{.participants = 1000, .servo_trials = 25000};
  const CueReport cues = fake_cues(options);
  const std::vector<Figure> figures = report_figures(fake_report(options), {.cues = &cues});
  for (const std::string& svg : draw_figures(figures, FigureFormat::svg))
    CHECK(svg.size() < 300'000);
}

TEST_CASE("matplotlib and ggplot2 redraw every figure from the data beside it") {
  const bool python = std::system("/usr/bin/python3 -c 'import matplotlib' 2>/dev/null") == 0;
  const bool r = std::system("Rscript -e 'library(ggplot2)' >/dev/null 2>&1") == 0;
  if (!python || !r) WARN("skipped where matplotlib or ggplot2 is not installed");
  FakeReportOptions options{.classes = hostile_labels(), .methods = {"it's", "two"}};
  ExplorationPath path;
  path.texture.geometry = {0.2, 20, 30};
  path.texture.grey = GreyImage(20, 30, 100);
  path.points = {{{1.5, 2.5}, {}, 0.25, true}, {{2.0, 3.0}, {}, 0.5, true}};
  const CueReport cues = fake_cues(options);
  const TempFolder folder;
  for (const Figure& figure :
       report_figures(fake_report(options), {.cues = &cues, .explorations = {&path, 1}})) {
    for (const auto& [name, content] : redraw_files(figure)) {
      replace_file(folder.path() / name, content);
    }
    const std::string stem = (folder.path() / figure.id).string();
    INFO(figure.id);
    if (python) {
      CHECK(std::system(
                ("/usr/bin/python3 " + stem + ".py " + stem + "-1.pdf >/dev/null 2>&1").c_str()) ==
            0);
    }
    if (r)
      CHECK(std::system(("Rscript " + stem + ".r " + stem + "-2.pdf >/dev/null 2>&1").c_str()) ==
            0);
  }
}

TEST_CASE("figures without gnuplot say what to install") {
  const Figure figure = report_figures(fake_report()).front();
  const EmptyPath without;
  CHECK(contains(
      message_of<Error>([&] { static_cast<void>(draw_figure(figure, FigureFormat::svg)); }),
      "install gnuplot-nox"));
}
