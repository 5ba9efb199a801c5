#include "analysis/page/sources.hpp"

namespace touchtrial::analysis {

std::string_view citation_of(Source source) noexcept {
  switch (source) {
    case Source::wilson:
      return "Wilson, E. B. (1927). Probable inference, the law of succession, and statistical "
             "inference. Journal of the American Statistical Association, 22(158), 209–212.";
    case Source::clopper_pearson:
      return "Clopper, C. J., & Pearson, E. S. (1934). The use of confidence or fiducial limits "
             "illustrated in the case of the binomial. Biometrika, 26(4), 404–413.";
    case Source::brown_cai_dasgupta:
      return "Brown, L. D., Cai, T. T., & DasGupta, A. (2001). Interval estimation for a binomial "
             "proportion. Statistical Science, 16(2), 101–133.";
    case Source::student:
      return "Student (1908). The probable error of a mean. Biometrika, 6(1), 1–25.";
    case Source::davison_hinkley:
      return "Davison, A. C., & Hinkley, D. V. (1997). Bootstrap Methods and their Application. "
             "Cambridge University Press.";
    case Source::hesterberg:
      return "Hesterberg, T. C. (2015). What teachers should know about the bootstrap: Resampling "
             "in "
             "the undergraduate statistics curriculum. The American Statistician, 69(4), 371–386.";
    case Source::phipson_smyth:
      return "Phipson, B., & Smyth, G. K. (2010). Permutation p-values should never be zero: "
             "calculating exact p-values when permutations are randomly drawn. Statistical "
             "Applications in Genetics and Molecular Biology, 9(1), 39.";
    case Source::green_swets:
      return "Green, D. M., & Swets, J. A. (1966). Signal Detection Theory and Psychophysics. "
             "Wiley.";
    case Source::hacker_ratcliff:
      return "Hacker, M. J., & Ratcliff, R. (1979). A revised table of d′ for M-alternative forced "
             "choice. Perception & Psychophysics, 26(2), 168–170.";
    case Source::tan_reed_durlach:
      return "Tan, H. Z., Reed, C. M., & Durlach, N. I. (2010). Optimum information transfer rates "
             "for communication through haptic and other sensory modalities. IEEE Transactions on "
             "Haptics, 3(2), 98–108.";
    case Source::miller:
      return "Miller, G. A. (1955). Note on the bias of information estimates. In H. Quastler "
             "(Ed.), Information Theory in Psychology (pp. 95–100). Free Press.";
    case Source::luce:
      return "Luce, R. D. (1963). Detection and recognition. In R. D. Luce, R. R. Bush, & "
             "E. Galanter (Eds.), Handbook of Mathematical Psychology (Vol. 1, pp. 103–189). "
             "Wiley.";
    case Source::townsend_landon:
      return "Townsend, J. T., & Landon, D. E. (1982). An experimental and theoretical "
             "investigation of the constant-ratio rule and other models of visual letter "
             "confusion. Journal of Mathematical Psychology, 25(2), 119–162.";
    case Source::hyndman_fan:
      return "Hyndman, R. J., & Fan, Y. (1996). Sample quantiles in statistical packages. The "
             "American Statistician, 50(4), 361–365.";
    case Source::fagerland:
      return "Fagerland, M. W., Lydersen, S., & Laake, P. (2013). The McNemar test for binary "
             "matched-pairs data: mid-p and asymptotic are better than exact conditional. BMC "
             "Medical Research Methodology, 13, 91.";
    case Source::cochran:
      return "Cochran, W. G. (1950). The comparison of percentages in matched samples. "
             "Biometrika, 37(3/4), 256–266.";
    case Source::holm:
      return "Holm, S. (1979). A simple sequentially rejective multiple test procedure. "
             "Scandinavian Journal of Statistics, 6(2), 65–70.";
    case Source::mantel_haenszel:
      return "Mantel, N., & Haenszel, W. (1959). Statistical aspects of the analysis of data from "
             "retrospective studies of disease. Journal of the National Cancer Institute, 22(4), "
             "719–748.";
    case Source::robins_breslow_greenland:
      return "Robins, J., Breslow, N., & Greenland, S. (1986). Estimators of the Mantel-Haenszel "
             "variance consistent in both sparse data and large-strata limiting models. "
             "Biometrics, 42(2), 311–323.";
    case Source::lin:
      return "Lin, J. (1991). Divergence measures based on the Shannon entropy. IEEE Transactions "
             "on Information Theory, 37(1), 145–151.";
    case Source::kuhn:
      return "Kuhn, H. W. (1955). The Hungarian method for the assignment problem. Naval Research "
             "Logistics Quarterly, 2(1–2), 83–97.";
    case Source::williams:
      return "Williams, E. J. (1949). Experimental designs balanced for the estimation of residual "
             "effects of treatments. Australian Journal of Scientific Research A, 2(2), 149–168.";
  }
  return "";
}

}  // namespace touchtrial::analysis
