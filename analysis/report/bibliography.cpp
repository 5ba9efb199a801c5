#include "analysis/report/bibliography.hpp"

#include <array>
#include <cstddef>

namespace touchtrial::analysis {
namespace {

constexpr std::array kPublications = {
    Publication{Source::benjamini_hochberg, "benjamini1995",
                "Benjamini Y, Hochberg Y (1995). Controlling the false discovery rate: a practical "
                "and powerful approach to multiple testing. Journal of the Royal Statistical "
                "Society B 57(1), 289-300."},
    Publication{
        Source::brown_cai_dasgupta, "brown2001",
        "Brown LD, Cai TT, DasGupta A (2001). Interval estimation for a binomial proportion. "
        "Statistical Science 16(2), 101-133."},
    Publication{
        Source::clopper_pearson, "clopper1934",
        "Clopper CJ, Pearson ES (1934). The use of confidence or fiducial limits illustrated "
        "in the case of the binomial. Biometrika 26(4), 404-413."},
    Publication{Source::cochran, "cochran1950",
                "Cochran WG (1950). The comparison of percentages in matched samples. Biometrika "
                "37(3/4), 256-266."},
    Publication{Source::cumming_finch, "cumming2001",
                "Cumming G, Finch S (2001). A primer on the understanding, use, and calculation of "
                "confidence intervals that are based on central and noncentral distributions. "
                "Educational and Psychological Measurement 61(4), 532-574."},
    Publication{Source::davison_hinkley, "davison1997",
                "Davison AC, Hinkley DV (1997). Bootstrap Methods and their Application. Cambridge "
                "University Press."},
    Publication{
        Source::fagerland, "fagerland2013",
        "Fagerland MW, Lydersen S, Laake P (2013). The McNemar test for binary matched-pairs data: "
        "mid-p and asymptotic are better than exact conditional. BMC Medical Research Methodology "
        "13, 91."},
    Publication{Source::fischer_whitney, "fischer2014",
                "Fischer J, Whitney D (2014). Serial dependence in visual perception. Nature "
                "Neuroscience 17(5), 738-743."},
    Publication{Source::fleming_lau, "fleming2014",
                "Fleming SM, Lau HC (2014). How to measure metacognition. Frontiers in Human "
                "Neuroscience 8, 443."},
    Publication{Source::green_swets, "green1966",
                "Green DM, Swets JA (1966). Signal Detection Theory and Psychophysics. Wiley."},
    Publication{Source::hacker_ratcliff, "hacker1979",
                "Hacker MJ, Ratcliff R (1979). A revised table of d' for M-alternative forced "
                "choice. Perception & Psychophysics 26(2), 168-170."},
    Publication{
        Source::hesterberg, "hesterberg2015",
        "Hesterberg TC (2015). What teachers should know about the bootstrap: resampling in "
        "the undergraduate statistics curriculum. The American Statistician 69(4), 371-386."},
    Publication{Source::hills_armitage, "hills1979",
                "Hills M, Armitage P (1979). The two-period cross-over clinical trial. British "
                "Journal of Clinical Pharmacology 8(1), 7-20."},
    Publication{Source::holm, "holm1979",
                "Holm S (1979). A simple sequentially rejective multiple test procedure. "
                "Scandinavian Journal of Statistics 6(2), 65-70."},
    Publication{Source::hu_song, "hu2022",
                "Hu H, Song A (2022). Haptic texture rendering of 2D image based on adaptive "
                "fractional differential method. Applied Sciences 12(23), 12346.",
                true},
    Publication{Source::hyndman_fan, "hyndman1996",
                "Hyndman RJ, Fan Y (1996). Sample quantiles in statistical packages. The American "
                "Statistician 50(4), 361-365."},
    Publication{Source::ince, "ince2021",
                "Ince RAA, Paton AT, Kay JW, Schyns PG (2021). Bayesian inference of population "
                "prevalence. eLife 10, e62461."},
    Publication{Source::inthout, "inthout2014",
                "IntHout J, Ioannidis JPA, Borm GF (2014). The Hartung-Knapp-Sidik-Jonkman method "
                "for random effects meta-analysis is straightforward and considerably outperforms "
                "the standard DerSimonian-Laird method. BMC Medical Research Methodology 14, 25."},
    Publication{Source::kaernbach, "kaernbach1991",
                "Kaernbach C (1991). Simple adaptive testing with the weighted up-down method. "
                "Perception & Psychophysics 49(3), 227-229.",
                true},
    Publication{Source::kontsevich_tyler, "kontsevich1999",
                "Kontsevich LL, Tyler CW (1999). Bayesian adaptive estimation of psychometric "
                "slope and threshold. Vision Research 39(16), 2729-2737.",
                true},
    Publication{Source::kuhn, "kuhn1955",
                "Kuhn HW (1955). The Hungarian method for the assignment problem. Naval Research "
                "Logistics Quarterly 2(1-2), 83-97."},
    Publication{Source::lan_demets, "lan1983",
                "Lan KKG, DeMets DL (1983). Discrete sequential boundaries for clinical trials. "
                "Biometrika 70(3), 659-663.",
                true},
    Publication{Source::levitt, "levitt1971",
                "Levitt H (1971). Transformed up-down methods in psychoacoustics. Journal of the "
                "Acoustical Society of America 49(2B), 467-477.",
                true},
    Publication{
        Source::lin, "lin1991",
        "Lin J (1991). Divergence measures based on the Shannon entropy. IEEE Transactions on "
        "Information Theory 37(1), 145-151."},
    Publication{
        Source::luce, "luce1963",
        "Luce RD (1963). Detection and recognition. In: Luce RD, Bush RR, Galanter E (eds), "
        "Handbook of Mathematical Psychology, vol. 1, 103-189. Wiley."},
    Publication{Source::mantel_haenszel, "mantel1959",
                "Mantel N, Haenszel W (1959). Statistical aspects of the analysis of data from "
                "retrospective studies of disease. Journal of the National Cancer Institute 22(4), "
                "719-748."},
    Publication{Source::miller, "miller1955",
                "Miller GA (1955). Note on the bias of information estimates. In: Quastler H (ed), "
                "Information Theory in Psychology, 95-100. Free Press."},
    Publication{Source::miller_jackknife, "miller1974",
                "Miller RG (1974). The jackknife: a review. Biometrika 61(1), 1-15."},
    Publication{Source::paule_mandel, "paule1982",
                "Paule RC, Mandel J (1982). Consensus values and weighting factors. Journal of "
                "Research of the National Bureau of Standards 87(5), 377-385."},
    Publication{
        Source::phipson_smyth, "phipson2010",
        "Phipson B, Smyth GK (2010). Permutation p-values should never be zero: calculating exact "
        "p-values when permutations are randomly drawn. Statistical Applications in Genetics and "
        "Molecular Biology 9(1), article 39."},
    Publication{Source::prins, "prins2013",
                "Prins N (2013). The psi-marginal adaptive method: how to give nuisance parameters "
                "the attention they deserve (no more, no less). Journal of Vision 13(7), 3.",
                true},
    Publication{
        Source::robins_breslow_greenland, "robins1986",
        "Robins J, Breslow N, Greenland S (1986). Estimators of the Mantel-Haenszel variance "
        "consistent in both sparse data and large-strata limiting models. Biometrics 42(2), "
        "311-323."},
    Publication{Source::senn, "senn2002",
                "Senn S (2002). Cross-over Trials in Clinical Research, second edition. Wiley."},
    Publication{Source::shrout_fleiss, "shrout1979",
                "Shrout PE, Fleiss JL (1979). Intraclass correlations: uses in assessing rater "
                "reliability. Psychological Bulletin 86(2), 420-428.",
                true},
    Publication{Source::student, "student1908",
                "Student (1908). The probable error of a mean. Biometrika 6(1), 1-25."},
    Publication{Source::tan_reed_durlach, "tan2010",
                "Tan HZ, Reed CM, Durlach NI (2010). Optimum information transfer rates for "
                "communication through haptic and other sensory modalities. IEEE Transactions on "
                "Haptics 3(2), 98-108."},
    Publication{Source::tobin, "tobin1958",
                "Tobin J (1958). Estimation of relationships for limited dependent variables. "
                "Econometrica 26(1), 24-36."},
    Publication{
        Source::townsend_landon, "townsend1982",
        "Townsend JT, Landon DE (1982). An experimental and theoretical investigation of the "
        "constant-ratio rule and other models of visual letter confusion. Journal of Mathematical "
        "Psychology 25(2), 119-162."},
    Publication{Source::veale, "veale2014",
                "Veale JF (2014). Edinburgh Handedness Inventory - Short Form: a revised version "
                "based on confirmatory factor analysis. Laterality 19(2), 164-177.",
                true},
    Publication{Source::viechtbauer, "viechtbauer2007",
                "Viechtbauer W (2007). Confidence intervals for the amount of heterogeneity in "
                "meta-analysis. Statistics in Medicine 26(1), 37-52."},
    Publication{Source::wagner, "wagner1993",
                "Wagner HL (1993). On measuring performance in category judgment studies of "
                "nonverbal behavior. Journal of Nonverbal Behavior 17(1), 3-28."},
    Publication{Source::watson, "watson2017",
                "Watson AB (2017). QUEST+: a general multidimensional Bayesian adaptive "
                "psychometric method. Journal of Vision 17(3), 10.",
                true},
    Publication{Source::wichmann_hill, "wichmann2001",
                "Wichmann FA, Hill NJ (2001). The psychometric function: I. Fitting, sampling, and "
                "goodness of fit. Perception & Psychophysics 63(8), 1293-1313.",
                true},
    Publication{Source::wilson, "wilson1927",
                "Wilson EB (1927). Probable inference, the law of succession, and statistical "
                "inference. Journal of the American Statistical Association 22(158), 209-212."},
};

constexpr bool are_in_order() {
  for (std::size_t i = 0; i < kPublications.size(); ++i) {
    if (static_cast<std::size_t>(kPublications[i].source) != i) return false;
    if (i > 0 && kPublications[i - 1].key >= kPublications[i].key) return false;
  }
  return true;
}
static_assert(are_in_order());

}  // namespace

std::span<const Publication> publications() noexcept {
  return kPublications;
}

std::string_view citation_of(Source source) noexcept {
  return kPublications[static_cast<std::size_t>(source)].text;
}

}  // namespace touchtrial::analysis
