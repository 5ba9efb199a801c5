# The functions of threshold_model.R: one model of all participants' trials, a probit with a guess
# and a lapse rate and random intercepts and slopes of participants (Moscatelli, Mezzetti, Lacquaniti
# 2012), and the threshold of each standard with its interval by the delta method. Run as a script,
# with --csv for all digits; sourced, it only defines.

read_trials <- function(file) {
  trials <- read.csv(file, na.strings = "", encoding = "UTF-8",
                     colClasses = c(participant = "character", standard = "character"))
  trials$participant <- factor(trials$participant)
  trials$standard <- factor(trials$standard, levels = unique(trials$standard))
  # Levels near 0 that differ by about 1 help the search.
  trials$x <- (trials$level_db - centre_db) / scale_db
  trials
}

# p = guess + (1 - guess - lapse) pnorm(eta): the link of psyphy::probit.lambda(1 / guess, lapse).
guessing_probit <- function(guess, lapse) {
  range <- 1 - guess - lapse
  little <- 1e-9
  structure(list(
    linkfun = function(mu) qnorm(pmin(pmax((mu - guess) / range, little), 1 - little)),
    linkinv = function(eta) guess + range * pnorm(eta),
    mu.eta = function(eta) pmax(range * dnorm(eta), little),
    valideta = function(eta) TRUE,
    name = "guessing probit"), class = "link-glm")
}

# A slope and an intercept for each standard. Participants differ in both, or if the trials do not
# determine that, in the intercept.
random_parts <- c("(1 + x | participant)", "(1 + x || participant)", "(1 | participant)")

formula_of <- function(trials, random) {
  fixed <- if (nlevels(trials$standard) > 1) "0 + standard + standard:x" else "1 + x"
  as.formula(paste("correct ~", fixed, "+", random))
}

is_sound <- function(fit) !lme4::isSingular(fit) && is.null(fit@optinfo$conv$lme4$messages)

fitted_model <- function(trials) {
  family <- binomial(link = guessing_probit(guess, lapse))
  # The inner search ends late enough for the curvature, and so for standard errors.
  control <- lme4::glmerControl(optimizer = "bobyqa", tolPwrss = 1e-10,
                                optCtrl = list(maxfun = 2e5))
  fit <- NULL
  for (random in random_parts) {
    fit <- tryCatch(
      suppressMessages(suppressWarnings(lme4::glmer(formula_of(trials, random), data = trials,
                                                    family = family, control = control))),
      error = function(e) NULL)
    if (!is.null(fit) && is_sound(fit)) {
      message("Random effects: ", random)
      return(fit)
    }
  }
  if (is.null(fit)) stop("the trials do not determine the model; use the report's thresholds")
  message("The model is singular or did not converge: do not quote its intervals.")
  fit
}

# Names of the intercept and the slope of each standard.
terms_of <- function(trials) {
  standards <- levels(trials$standard)
  if (length(standards) < 2) return(data.frame(standard = standards, a = "(Intercept)", b = "x"))
  data.frame(standard = standards, a = paste0("standard", standards),
             b = paste0("standard", standards, ":x"))
}

# The level at which pnorm(a + b x) is the share of F at the study's threshold, with an interval by
# the delta method.
thresholds_of <- function(fit, trials) {
  estimate <- lme4::fixef(fit)
  covariance <- as.matrix(vcov(fit))
  wanted <- qnorm(share_at_threshold)
  rows <- lapply(split(terms_of(trials), seq_len(nlevels(trials$standard))), function(term) {
    names <- c(term$a, term$b)
    a <- estimate[[names[1]]]
    b <- estimate[[names[2]]]
    gradient <- c(-1 / b, -(wanted - a) / b^2)
    error <- sqrt(drop(gradient %*% covariance[names, names] %*% gradient)) * scale_db
    threshold <- centre_db + scale_db * (wanted - a) / b
    reach <- qnorm(0.975) * error
    data.frame(standard = term$standard, threshold_db = threshold, low = threshold - reach,
               high = threshold + reach, slope_per_db = b / scale_db)
  })
  do.call(rbind, rows)
}

main <- function(arguments) {
  if (!requireNamespace("lme4", quietly = TRUE)) stop("install lme4: install.packages(\"lme4\")")
  trials <- read_trials("threshold_model.csv")
  if (nlevels(trials$participant) < 3) stop("a model over participants needs three or more")
  fit <- fitted_model(trials)
  result <- thresholds_of(fit, trials)
  if ("--csv" %in% arguments) {
    write.csv(result, stdout(), row.names = FALSE)
  } else {
    print(summary(fit, correlation = FALSE))
    print(result, digits = 4, row.names = FALSE)
  }
}

if (sys.nframe() == 0) main(commandArgs(trailingOnly = TRUE))
