# The functions of threshold_model.R: one model of all participants' trials. It is the study's
# psychometric function with a guess and a lapse rate (Moscatelli, Mezzetti, Lacquaniti 2012), and
# random intercepts and slopes of participants and of participants' standards. Results are the
# threshold of each standard and the differences of all pairs, with intervals by the delta method.
# As a script it prints the results (--csv: with all digits); if sourced, it only defines functions.

most_lapses <- 0.2

read_trials <- function(file) {
  prepared(read.csv(file, na.strings = "", encoding = "UTF-8",
                    colClasses = c(participant = "character", standard = "character")))
}

# One row for each participant, standard and level, with how often it was answered right and wrong.
# x is the level from the middle of its standard's tracks, about 1 apart: near 0 an intercept and a
# slope hardly depend on each other.
prepared <- function(trials) {
  trials$participant <- factor(trials$participant)
  trials$standard <- factor(trials$standard, levels = unique(trials$standard))
  in_track <- trials$kind == "track"
  middle <- tapply(trials$level_db[in_track], trials$standard[in_track], mean)
  counts <- aggregate(cbind(right = correct, wrong = 1 - correct) ~
                        participant + standard + level_db, trials, sum)
  counts$centre <- as.vector(middle[counts$standard])
  counts$x <- (counts$level_db - counts$centre) / scale_db
  counts
}

# F, its slope and its inverse. F is as in the report; at its threshold eta is 0.
functions <- list(
  weibull = list(share = function(eta) -expm1(-exp(pmin(eta, 30))),
                 slope = function(eta) exp(pmin(eta, 30) - exp(pmin(eta, 30))),
                 inverse = function(p) log(-log1p(-p))),
  logistic = list(share = plogis, slope = dlogis, inverse = qlogis),
  normal = list(share = pnorm, slope = dnorm, inverse = qnorm))

# p = guess + (1 - guess - lapse) F(eta): psyphy's links mafc.cloglog, mafc.logit and mafc.probit, with
# lapses.
guessing_link <- function(guess, lapse) {
  f <- functions[[shape]]
  range <- 1 - guess - lapse
  little <- 1e-9
  structure(list(
    linkfun = function(mu) f$inverse(pmin(pmax((mu - guess) / range, little), 1 - little)),
    linkinv = function(eta) guess + range * f$share(eta),
    mu.eta = function(eta) pmax(range * f$slope(eta), little),
    valideta = function(eta) TRUE,
    name = paste("guessing", shape)), class = "link-glm")
}

# The random effects of participants, starting with the most complete. All include the standards: a
# model in which people differ equally at all standards mistakes chance for a difference between
# standards too often.
random_parts <- function(trials) {
  if (nlevels(trials$standard) < 2) {
    return(c("(1 + x | participant)", "(1 + x || participant)", "(1 | participant)"))
  }
  c("(1 + x | participant) + (1 + x | participant:standard)",
    "(1 + x || participant) + (1 + x || participant:standard)",
    "(1 + x || participant) + (1 | participant:standard)",
    "(1 | participant) + (1 | participant:standard)")
}

# An intercept and a slope for each standard.
formula_of <- function(trials, random) {
  fixed <- if (nlevels(trials$standard) > 1) "0 + standard + standard:x" else "1 + x"
  as.formula(paste("cbind(right, wrong) ~", fixed, "+", random))
}

# The fit, or NULL if there is none. quick: fixed effects are not optimised but follow from the
# other parameters, which suffices to compare models.
fit_of <- function(trials, random, lapse, quick = FALSE) {
  control <- lme4::glmerControl(optimizer = "bobyqa", calc.derivs = FALSE,
                                tolPwrss = if (quick) 1e-7 else 1e-9,
                                optCtrl = list(maxfun = 2e5, rhoend = if (quick) 1e-4 else 1e-5))
  tryCatch(suppressMessages(suppressWarnings(
    lme4::glmer(formula_of(trials, random), data = trials, nAGQ = if (quick) 0 else 1,
                family = binomial(link = guessing_link(guess, lapse)), control = control))),
    error = function(e) NULL)
}

# The lapse rate of all participants: the maximum of the likelihood, with a separate intercept for
# every participant and standard, times the density Beta(1, 10), which the report also uses. It is
# determined mostly by trials at the highest level.
lapse_of <- function(trials) {
  random <- if (nlevels(trials$standard) > 1) "(1 | participant:standard)" else "(1 | participant)"
  cost <- function(lapse) {
    fit <- fit_of(trials, random, lapse, quick = TRUE)
    if (is.null(fit)) return(1e10)
    -as.numeric(logLik(fit)) - 9 * log(1 - lapse)
  }
  optimise(cost, c(0, most_lapses), tol = 0.004)$minimum
}

is_sound <- function(fit) !is.null(fit) && fit@optinfo$conv$opt == 0
is_determined <- function(fit) is_sound(fit) && !lme4::isSingular(fit)

# The first model that the trials determine; if there is none, the last model. said: what was
# fitted, and why no larger model was used.
fitted_model <- function(trials) {
  lapse <- lapse_of(trials)
  said <- sprintf("Lapse rate, one for all participants: %.3f.", lapse)
  for (random in random_parts(trials)) {
    quick <- fit_of(trials, random, lapse, quick = TRUE)
    fit <- if (!is.null(quick) && !lme4::isSingular(quick)) fit_of(trials, random, lapse)
    if (is_determined(fit)) {
      return(list(fit = fit, said = c(said, paste0("Random effects: ", random, "."))))
    }
    said <- c(said, paste0("Random effects: ", random, ": not used, because the trials do not ",
                           "determine them (singular, or not converged)."))
  }
  fit <- fit_of(trials, random, lapse)
  if (is.null(fit)) stop("the trials do not determine the model; use the report's thresholds")
  list(fit = fit, said = c(said, paste0(
    "Random effects: ", random, ", the least that is fitted. ",
    if (is_sound(fit)) "A variance is estimated as 0, which does not show that there is none."
    else "The search did not converge: do not quote the intervals.")))
}

# The names of the intercept and the slope of each standard, and the centre of its levels.
terms_of <- function(trials) {
  standards <- levels(trials$standard)
  several <- length(standards) > 1
  data.frame(standard = standards,
             a = if (several) paste0("standard", standards) else "(Intercept)",
             b = if (several) paste0("standard", standards, ":x") else "x",
             centre = trials$centre[match(standards, trials$standard)])
}

# The levels at which a + b x is 0, with their covariance by the delta method.
levels_of <- function(fit, trials) {
  estimate <- lme4::fixef(fit)
  terms <- terms_of(trials)
  a <- estimate[terms$a]
  b <- estimate[terms$b]
  gradient <- matrix(0, nrow(terms), length(estimate), dimnames = list(NULL, names(estimate)))
  for (i in seq_len(nrow(terms))) {
    gradient[i, terms$a[i]] <- -scale_db / b[i]
    gradient[i, terms$b[i]] <- scale_db * a[i] / b[i]^2
  }
  list(standard = terms$standard, level = unname(terms$centre - scale_db * a / b),
       covariance = gradient %*% as.matrix(vcov(fit)) %*% t(gradient))
}

# Thresholds, and the difference of each pair, first minus second. Intervals have as many degrees of
# freedom as participants, minus one. Errors are multiplied by sqrt(n / (n - 1)), because maximum
# likelihood treats the means as known when it estimates how people differ.
results_of <- function(fit, trials) {
  found <- levels_of(fit, trials)
  n <- nlevels(trials$participant)
  row <- function(what, weights) {
    error <- sqrt(drop(weights %*% found$covariance %*% weights) * n / (n - 1))
    estimate <- sum(weights * found$level)
    reach <- qt(0.975, n - 1) * error
    data.frame(what, estimate_db = estimate, low = estimate - reach, high = estimate + reach)
  }
  one <- diag(length(found$level))
  rows <- lapply(seq_along(found$level), function(i) row(found$standard[i], one[i, ]))
  if (length(found$level) > 1) {
    rows <- c(rows, combn(length(found$level), 2, simplify = FALSE, FUN = function(pair) {
      row(paste(found$standard[pair[1]], "less", found$standard[pair[2]]),
          one[pair[1], ] - one[pair[2], ])
    }))
  }
  do.call(rbind, rows)
}

main <- function(arguments) {
  if (!requireNamespace("lme4", quietly = TRUE)) {
    stop("install lme4: install.packages(\"lme4\"), or on Debian apt-get install r-cran-lme4")
  }
  trials <- read_trials("threshold_model.csv")
  if (nlevels(trials$participant) < 3) stop("a model over participants needs three or more")
  model <- fitted_model(trials)
  message(paste(strwrap(model$said, 98, exdent = 2), collapse = "\n"))
  results <- results_of(model$fit, trials)
  if ("--csv" %in% arguments) {
    write.csv(results, stdout(), row.names = FALSE)
  } else {
    print(lme4::VarCorr(model$fit))
    print(results, digits = 4, row.names = FALSE)
  }
}

if (sys.nframe() == 0) main(commandArgs(trailingOnly = TRUE))
