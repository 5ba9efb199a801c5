#include "analysis/page/sections.hpp"

namespace touchtrial::analysis {

Section methods_section(const StudyReport& /*report*/) {
  Section section{"methods", "How these figures were made", {}};
  section.blocks.emplace_back(Cited{
      "Every figure is made by the program named above from the database named above; "
      "results.json, beside this page, holds the same figures with all their digits. Under each "
      "table stands what its figures are and where the method comes from. Intervals hold 95% "
      "nominally. Resampling draws from a random stream of fixed seed, so that the same database "
      "gives the same figures on every machine.",
      {}});
  section.blocks.emplace_back(Definitions{
      {{"unit of analysis",
        "The participant. Trials pooled over participants are shown for looking at; intervals and "
        "tests that take them as independent are marked."},
       {"missing responses",
        "Wrong in every accuracy; left out of information transfer and of the choice model. The "
        "tables with and without show what depends on it."},
       {"right or wrong",
        "An answer is right if its picture is of the class that was presented, whichever exemplar "
        "of it."},
       {"blinding",
        "What was presented was sealed before trial 1 and opened by a recorded event; touchtrial "
        "verify DB holds every event, the seal and the schedules against each other, and the head "
        "of the file's chain named above tells whether this report is of the same file."}}});
  return section;
}

}  // namespace touchtrial::analysis
