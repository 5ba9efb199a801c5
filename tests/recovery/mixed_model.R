# Rscript tests/recovery/mixed_model.R STUDIES: the exported script's two analyses, and the model that it
# replaced, on simulated studies of two methods that do not differ. Prints rows of
# docs/statistics-recovery.md; each line comes from STUDIES studies.
arguments <- commandArgs(trailingOnly = FALSE)
here <- dirname(normalizePath(sub("^--file=", "", grep("^--file=", arguments, value = TRUE))))
source(file.path(here, "../../protocols/identification/analysis/mixed_model_functions.R"))
studies <- as.integer(commandArgs(trailingOnly = TRUE)[1])
if (is.na(studies) || studies < 10) stop("usage: Rscript mixed_model.R STUDIES (10 or more)")

# Log odds of a right answer: 1.2, with SDs between participants and images; methods in blocks of their
# own, in either order.
study_of <- function(n, images, repeats, slope, image_slope, period) {
  image <- rnorm(images, sd = 0.5)
  image_method <- rnorm(images, sd = image_slope)
  trials <- expand.grid(repeat_ = seq_len(repeats), picture = seq_len(images), m = 0:1, person = seq_len(n))
  person <- rnorm(n, sd = 0.8)
  person_method <- rnorm(n, sd = slope)
  trials$block <- as.integer(trials$m == trials$person %% 2)
  log_odds <- 1.2 + person[trials$person] + image[trials$picture] + period * (trials$block - 0.5) +
    (trials$m - 0.5) * (person_method[trials$person] + image_method[trials$picture])
  data.frame(participant = paste0("P", trials$person), method = c("a", "b")[trials$m + 1], class = "x",
             image = paste0("i", trials$picture), block = trials$block,
             correct = rbinom(nrow(trials), 1, plogis(log_odds)), chance = 0.2, simulated = 1)
}

# The p of the model with random intercepts alone.
replaced_p <- function(trials) {
  fit <- tryCatch(suppressMessages(suppressWarnings(lme4::glmer(
    correct ~ method + (1 | participant) + (1 | image), trials, binomial))), error = function(e) NULL)
  if (is.null(fit)) NA else summary(fit)$coefficients[2, 4]
}

p_values <- function(number, population) {
  set.seed(number)
  trials <- prepared(do.call(study_of, population), c("a", "b"))
  model <- of_trials(trials)$rows
  c(t = of_participants(trials)$p, model = if (is.null(model)) NA else model$p, replaced = replaced_p(trials))
}

line <- function(statistic, who, p, least, most, why) {
  p <- p[!is.na(p)]
  share <- mean(p <= 0.05)
  error <- max(sqrt(share * (1 - share) / length(p)), 1 / length(p))
  holds <- share >= least - 4 * error && share <= most + 4 * error
  cat(sprintf("| %s | %s | 0.05 | %.4f | %.4f | %s | %s |\n", statistic, who, share, error,
              if (holds) "yes" else "NO", why))
}

populations <- list(
  list(n = 20, images = 5, repeats = 5, slope = 0, image_slope = 0, period = 0.5),
  list(n = 20, images = 5, repeats = 5, slope = 0.6, image_slope = 0, period = 0.5),
  list(n = 20, images = 12, repeats = 2, slope = 0.3, image_slope = 0.5, period = 0))
cat("\n## type-I error of the exported R script\n\n| statistic | population | nominal | found | Monte-Carlo error |",
    "as expected | remark |\n| --- | --- | --- | --- | --- | --- | --- |\n")
for (population in populations) {
  who <- with(population, sprintf(
    "%d participants, %d images, log odds of method by participant of SD %g, by image of SD %g, period %g",
    n, images, slope, image_slope, period))
  p <- t(sapply(seq_len(studies), p_values, population))
  random <- population$images >= fewest_random_images
  line("R script, t over participants", who, p[, "t"], if (random) 0.05 else 0.035, if (random) 0.5 else 0.06,
       if (random) "says nothing of other images, and is not meant to" else "an approximation")
  line("R script, model where there is one", who, p[, "model"], 0, 0.08,
       sprintf("an approximation; there is one in %.0f %% of studies", 100 * mean(!is.na(p[, "model"]))))
  line("random intercepts alone (not printed)", who, p[, "replaced"], 0.02, 0.6,
       "the model that the script replaced")
}
