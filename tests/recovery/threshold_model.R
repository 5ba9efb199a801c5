# Rscript tests/recovery/threshold_model.R STUDIES: what the exported script of thresholds covers, and the model
# that it replaced, on simulated studies of three standards. Prints rows of docs/procedures-recovery.md.
arguments <- commandArgs(trailingOnly = FALSE)
here <- dirname(normalizePath(sub("^--file=", "", grep("^--file=", arguments, value = TRUE))))
source(file.path(here, "../../protocols/threshold/analysis/threshold_model_functions.R"))
studies <- as.integer(commandArgs(trailingOnly = TRUE)[1])
if (is.na(studies) || studies < 10) stop("usage: Rscript threshold_model.R STUDIES (10 or more)")

guess <- 0.5
shape <- "weibull"
levels_db <- -20:16
scale_db <- diff(range(levels_db)) / 8
standards <- c("-18 dB", "-12 dB", "-6 dB")
truths <- c(3, -3, -8)
highest <- c(16, 9, 0)

share_right <- function(level, threshold, slope, lapse) {
  guess + (1 - guess - lapse) * (1 - exp(-10^(slope * (level - threshold) / 20)))
}

# One track: 60 trials near the mean of a belief about the threshold, whose slope is taken to be 3, and 6 at the
# highest level, which the belief does not hear of.
track_of <- function(threshold, slope, lapse, top) {
  grid <- seq(-30, 25)
  belief <- rep(0, length(grid))
  level <- numeric(66)
  correct <- integer(66)
  for (i in 1:66) {
    if (i %% 11 == 0) {
      level[i] <- top
      correct[i] <- rbinom(1, 1, share_right(top, threshold, slope, lapse))
      next
    }
    weights <- exp(belief - max(belief))
    wanted <- round(sum(weights * grid) / sum(weights)) + sample(c(-3, 0, 3), 1)
    level[i] <- min(max(wanted, min(levels_db)), top)
    correct[i] <- rbinom(1, 1, share_right(level[i], threshold, slope, lapse))
    believed <- share_right(level[i], grid, 3, 0.02)
    belief <- belief + log(if (correct[i] == 1) believed else 1 - believed)
  }
  data.frame(level_db = level, correct, kind = ifelse(1:66 %% 11 == 0, "catch", "track"))
}

# Thresholds are normal, slopes between 2 and 6.
study_of <- function(people, person_sd, standard_sd, lapse) {
  do.call(rbind, lapply(seq_len(people), function(person) {
    own <- rnorm(1, sd = person_sd)
    slope <- exp(runif(1, log(2), log(6)))
    do.call(rbind, lapply(seq_along(standards), function(i) {
      threshold <- truths[i] + own + rnorm(1, sd = standard_sd)
      cbind(participant = paste0("P", person), standard = standards[i],
            track_of(threshold, slope, lapse, highest[i]))
    }))
  }))
}

# What the script replaced: participants differ alike at all standards, the lapse rate is given, and intervals
# are normal.
replaced_results <- function(trials) {
  for (random in c("(1 + x | participant)", "(1 + x || participant)", "(1 | participant)")) {
    fit <- fit_of(trials, random, 0.025)
    if (is_determined(fit)) break
  }
  if (is.null(fit)) return(NULL)
  found <- levels_of(fit, trials)
  pairs <- rbind(diag(3), c(1, -1, 0), c(1, 0, -1), c(0, 1, -1))
  error <- sqrt(diag(pairs %*% found$covariance %*% t(pairs)))
  estimate <- drop(pairs %*% found$level)
  data.frame(estimate_db = estimate, low = estimate - 1.96 * error, high = estimate + 1.96 * error)
}

truth <- c(truths, truths[1] - truths[2], truths[1] - truths[3], truths[2] - truths[3])

figures_of <- function(results) {
  if (is.null(results)) return(rep(NA, 12))
  c(results$low <= truth & truth <= results$high, results$estimate_db - truth)
}

run <- function(number, population) {
  set.seed(number)
  trials <- prepared(do.call(study_of, population))
  model <- fitted_model(trials)
  replaced <- if (population$standard_sd > 0) replaced_results(trials)
  list(ours = figures_of(results_of(model$fit, trials)), replaced = figures_of(replaced),
       lapse = as.numeric(sub(".*: ([0-9.]+)\\.$", "\\1", model$said[1])), refused = length(model$said) - 2)
}

# A study whose model has no result, or none within half an hour, is reported and counted.
run_or_nothing <- function(number, population) {
  setTimeLimit(cpu = 1800, transient = TRUE)
  tryCatch(run(number, population), error = function(e) {
    message("study ", number, ": ", conditionMessage(e))
    NULL
  })
}

line <- function(what, who, runs, remark) {
  runs <- runs[, !is.na(runs[1, ]), drop = FALSE]
  share <- c(mean(runs[1:3, ]), mean(runs[4:6, ]))
  bias <- rowMeans(runs[7:9, , drop = FALSE])
  cat(sprintf("| %s | %s | %.3f | %.3f | %.3f | %+.2f to %+.2f | %s |\n", what, who, share[1], share[2],
              sqrt(0.05 * 0.95 / ncol(runs)), min(bias), max(bias), remark))
}

populations <- list(
  list(people = 12, person_sd = 3, standard_sd = 4, lapse = 0.02),
  list(people = 12, person_sd = 3, standard_sd = 4, lapse = 0.1),
  list(people = 12, person_sd = 3, standard_sd = 0, lapse = 0.02))
cat("\n## Coverage of the exported R script\n\n", studies,
    " studies a row, by `Rscript tests/recovery/threshold_model.R ", studies, "`: ", length(standards),
    " standards, tracks of 60 trials and 6 at\nthe highest level, Weibull observers with slopes of 2 to 6.\n\n",
    "| model | population | covers thresholds | covers differences | Monte-Carlo error of one | bias of thresholds, dB ",
    "| remark |\n| --- | --- | --- | --- | --- | --- | --- |\n", sep = "")
for (population in populations) {
  who <- with(population, sprintf("%d participants, SD between them %g dB, between their standards %g dB, lapse %g",
                                  people, person_sd, standard_sd, lapse))
  all_runs <- parallel::mclapply(seq_len(studies), run_or_nothing, population, mc.cores = parallel::detectCores())
  runs <- Filter(Negate(is.null), all_runs)
  of <- function(name) sapply(runs, function(one) one[[name]])
  line("exported script", who, of("ours"),
       sprintf(paste("lapse rate found: %.3f (SD %.3f); of the models more is fitted than intercepts in %.0f %%;",
                     "without a result: %d"),
               mean(of("lapse")), sd(of("lapse")), 100 * mean(of("refused") < 3), studies - length(runs)))
  if (population$standard_sd > 0) {
    line("participants alone (not printed)", who, of("replaced"), "the model that the script replaced")
  }
}
