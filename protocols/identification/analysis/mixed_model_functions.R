# The functions of mixed_model.R, which analyses mixed_model.csv twice. Participants: Student's t
# over participants' accuracies. Trials: a logit model with random effects of participants for
# everything that is compared; there is none if the trials cannot determine it. As a script it
# prints the results (--csv: with all digits); if sourced, it only defines functions.

fewest_random_images <- 10
fewest_participants <- 6
most_plausible_log_odds <- 10

read_trials <- function(file, methods) {
  text <- c("participant", "method", "class", "image", "response", "previous_class",
            "previous_response")
  trials <- read.csv(file, na.strings = "", encoding = "UTF-8",
                     colClasses = setNames(rep("character", length(text)), text))
  prepared(trials, methods)
}

# Converts columns to factors, and adds the period: the place of a trial's block among its
# participant's blocks.
prepared <- function(trials, methods) {
  trials$participant <- factor(trials$participant)
  trials$image <- factor(trials$image)
  trials$method <- droplevels(factor(trials$method, levels = methods))
  places <- function(blocks) match(blocks, sort(unique(blocks)))
  trials$period <- factor(ave(trials$block, trials$participant, FUN = places))
  trials
}

# People who do not differ have no t and no interval.
row_of <- function(statistic, first, second, estimate, error, df, null = 0) {
  if (error < 1e-12) error <- NA
  t <- (estimate - null) / error
  reach <- qt(0.975, df) * error
  data.frame(statistic, first, second, estimate, low = estimate - reach, high = estimate + reach, t,
             df, p = 2 * pt(-abs(t), df))
}

# --- Participants ---

accuracies <- function(trials) tapply(trials$correct, list(trials$participant, trials$method), mean)

# How many blocks later each participant felt the first method than the second; nothing if a block has
# both.
gap_of <- function(trials, first, second) {
  both <- trials[trials$method %in% c(first, second), ]
  block <- paste(both$participant, both$block)
  if (any(tapply(both$method, block, function(m) length(unique(m))) > 1)) return(NULL)
  place <- tapply(as.integer(both$period), list(both$participant, both$method), mean)
  place[, first] - place[, second]
}

# The mean difference. With methods in separate blocks it is adjusted to equal periods; for two
# methods this is the mean of the means of the two orders.
difference_of <- function(trials, first, second) {
  accuracy <- accuracies(trials)
  difference <- accuracy[, first] - accuracy[, second]
  felt <- !is.na(difference)
  gap <- gap_of(trials, first, second)[felt]
  difference <- difference[felt]
  if (length(difference) < 2) return(NULL)
  if (!is.null(gap) && all(table(gap) > 1) && length(unique(gap)) > 1) {
    fit <- lm(difference ~ gap)
    return(row_of("t, period-adjusted", first, second, coef(fit)[[1]], sqrt(vcov(fit)[1, 1]),
                  fit$df.residual))
  }
  n <- length(difference)
  row_of("t", first, second, mean(difference), sd(difference) / sqrt(n), n - 1)
}

against_chance <- function(trials) {
  accuracy <- accuracies(trials)[, 1]
  n <- length(accuracy)
  if (n < 2) return(NULL)
  row_of("t", levels(trials$method), "chance", mean(accuracy), sd(accuracy) / sqrt(n), n - 1,
         null = trials$chance[1])
}

pairs_of <- function(methods) {
  if (length(methods) < 2) list() else combn(methods, 2, simplify = FALSE)
}

of_participants <- function(trials) {
  pairs <- pairs_of(levels(trials$method))
  if (length(pairs) == 0) return(against_chance(trials))
  rows <- do.call(rbind, lapply(pairs, function(pair) difference_of(trials, pair[1], pair[2])))
  if (!is.null(rows)) rows$p_holm <- p.adjust(rows$p, "holm")
  rows
}

# --- Trials ---

# Whether every trial of some level, or of some combination of levels, is right, or every one wrong:
# the logit model's estimate is then infinite.
is_separated <- function(correct, ...) {
  share <- tapply(correct, list(...), mean)
  any(share == 0 | share == 1, na.rm = TRUE)
}

# The fixed terms that the trials can determine, with a sentence for each that was left out.
fixed_terms <- function(trials, columns) {
  said <- character()
  terms <- columns
  images <- nlevels(trials$image)
  crossed <- length(columns) > 0 && all(table(trials$method, trials$image) > 0)
  if (images > 1 && images < fewest_random_images) {
    if (is_separated(trials$correct, trials$image)) {
      said <- c(said, paste("Separation: every trial of some image is right, or wrong; images are",
                            "left out."))
    } else if (crossed && is_separated(trials$correct, trials$method, trials$image)) {
      said <- c(said, paste("Separation: every trial of some image with some method is right, or",
                            "wrong; the methods' effects are taken as equal for all images."))
      terms <- c(terms, "image")
    } else if (crossed) {
      terms <- c(terms, "image", paste0(columns, ":image"))
    } else {
      terms <- c(terms, "image")
    }
  }
  if (nlevels(trials$period) > 1) {
    design <- model.matrix(reformulate(c("1", terms, "period")), trials)
    if (qr(design)$rank < ncol(design)) {
      said <- c(said, "The period cannot be told from the methods here, and is left out.")
    } else if (is_separated(trials$correct, trials$period)) {
      said <- c(said, paste("Separation: every trial of some period is right, or wrong; periods are",
                            "left out."))
    } else {
      terms <- c(terms, "period")
    }
  }
  list(terms = terms, said = said)
}

# The random effects of participants, and of images if there are many: first with correlations, then
# without.
random_terms <- function(trials, columns) {
  inner <- paste(c("1", columns), collapse = " + ")
  groups <- c("participant", if (nlevels(trials$image) >= fewest_random_images) "image")
  bars <- if (length(columns) > 0) c(" | ", " || ") else " | "
  lapply(bars, function(bar) paste0("(", inner, bar, groups, ")"))
}

# The fit, or the reason why there is none, as text.
fitted_model <- function(formula, trials) {
  control <- lme4::glmerControl(optimizer = "bobyqa", optCtrl = list(maxfun = 1e5))
  fit <- tryCatch(suppressMessages(suppressWarnings(
    lme4::glmer(formula, data = trials, family = binomial, control = control))),
    error = function(failure) conditionMessage(failure))
  if (is.character(fit)) return(paste("it cannot be fitted:", fit))
  if (lme4::isSingular(fit)) {
    return("it is singular (a variance is estimated as 0, or a correlation as 1)")
  }
  if (length(fit@optinfo$conv$lme4$messages) > 0) return("it did not converge")
  size <- c(abs(lme4::fixef(fit)), sqrt(diag(as.matrix(vcov(fit)))))
  if (any(!is.finite(size) | size > most_plausible_log_odds)) return("an estimate runs away")
  fit
}

# Log odds ratios of all pairs, or the log odds of one method. There are as many degrees of freedom
# as participants, minus one, because the effects differ between participants.
of_model <- function(fit, trials, columns) {
  methods <- levels(trials$method)
  estimates <- lme4::fixef(fit)
  covariance <- as.matrix(vcov(fit))
  df <- nlevels(trials$participant) - 1
  if (length(columns) == 0) {
    return(row_of("log odds", methods, "chance", estimates[[1]], sqrt(covariance[1, 1]), df,
                  null = qlogis(trials$chance[1])))
  }
  codes <- contr.sum(length(methods))
  rownames(codes) <- methods
  rows <- lapply(pairs_of(methods), function(pair) {
    weights <- codes[pair[1], ] - codes[pair[2], ]
    error <- sqrt(drop(weights %*% covariance[columns, columns] %*% weights))
    row_of("log odds ratio", pair[1], pair[2], sum(weights * estimates[columns]), error, df)
  })
  rows <- do.call(rbind, rows)
  rows$p_holm <- p.adjust(rows$p, "holm")
  rows
}

# The rows of the first model that the trials determine, with the sentences to print.
of_trials <- function(trials) {
  none <- function(...) list(rows = NULL, said = c(...))
  if (!requireNamespace("lme4", quietly = TRUE)) {
    return(none(paste("No model: the package lme4 is missing; install.packages(\"lme4\"), or on",
                      "Debian apt-get install r-cran-lme4.")))
  }
  if (nlevels(trials$participant) < fewest_participants) {
    return(none(sprintf("No model: fewer than %d participants do not tell how people differ.",
                        fewest_participants)))
  }
  if (is_separated(trials$correct, trials$method)) {
    return(none("No model: every trial of some method is right, or wrong: infinite log odds."))
  }
  methods <- nlevels(trials$method)
  columns <- character()
  if (methods > 1) {
    columns <- paste0("method", seq_len(methods - 1))
    trials[columns] <- contr.sum(methods)[as.integer(trials$method), , drop = FALSE]
  }
  for (term in c("image", "period")) {
    if (nlevels(trials[[term]]) > 1) contrasts(trials[[term]]) <- contr.sum(nlevels(trials[[term]]))
  }
  fixed <- fixed_terms(trials, columns)
  said <- fixed$said
  for (random in random_terms(trials, columns)) {
    formula <- reformulate(c("1", fixed$terms, random), "correct")
    shown <- paste("Model:", paste(deparse(formula, width.cutoff = 500), collapse = ""))
    fit <- fitted_model(formula, trials)
    if (!is.character(fit)) {
      return(list(rows = of_model(fit, trials, columns), said = c(said, shown), fit = fit))
    }
    said <- c(said, paste0(shown, ": not used, because ", fit, "."))
  }
  none(said, "No model of the trials: quote the t over participants.")
}

# --- What is printed ---

as_p <- function(p) if (p < 1e-4) "p < 0.0001" else sprintf("p = %.3g", p)

in_words <- function(row) {
  if (is.na(row$t)) {
    return(sprintf("  %s against %s: people do not differ, so that there is no t\n", row$first,
                   row$second))
  }
  adjusted <- !is.null(row$p_holm) && row$p_holm != row$p
  holm <- if (adjusted) paste0(", ", as_p(row$p_holm), " after Holm") else ""
  test <- sprintf("t(%g) = %.2f, %s%s", row$df, row$t, as_p(row$p), holm)
  range <- function(f) sprintf("%.2f, 95 %% %.2f to %.2f", f(row$estimate), f(row$low), f(row$high))
  if (row$statistic == "log odds ratio") {
    return(sprintf("  %s against %s: odds ratio %s; %s\n", row$first, row$second, range(exp), test))
  }
  if (row$statistic == "log odds") {
    return(sprintf("  %s: right in %s (per cent, typical participant); against chance %s\n",
                   row$first, range(function(x) 100 * plogis(x)), test))
  }
  if (row$second == "chance") {
    return(sprintf("  %s: right in %s (per cent); against chance %s\n", row$first,
                   range(function(x) 100 * x), test))
  }
  sprintf("  %s less %s: %s points%s; %s\n", row$first, row$second, range(function(x) 100 * x),
          if (row$statistic == "t") "" else ", adjusted for the period", test)
}

print_rows <- function(rows) {
  for (i in seq_len(NROW(rows))) cat(in_words(rows[i, ]))
}

images_in_words <- function(trials) {
  images <- nlevels(trials$image)
  if (images < fewest_random_images) {
    return(sprintf("All of this holds for %s; nothing here can speak of other images.\n",
                   if (images == 1) "this one image" else sprintf("these %d images", images)))
  }
  sprintf(paste("Images are random in a model: it speaks of images of which these %d are a sample.",
                "The t does not.\n"), images)
}

main <- function(methods) {
  arguments <- commandArgs(trailingOnly = FALSE)
  script <- sub("^--file=", "", grep("^--file=", arguments, value = TRUE))
  folder <- if (length(script) == 1) dirname(normalizePath(script)) else getwd()
  trials <- read_trials(file.path(folder, "mixed_model.csv"), methods)
  if (nrow(trials) == 0) {
    message("No trial counts yet: there is nothing to analyse.")
    quit(save = "no", status = 1)
  }
  people <- of_participants(trials)
  model <- of_trials(trials)
  if ("--csv" %in% arguments) {
    rows <- rbind(people, model$rows)
    if (is.null(rows)) return(invisible())
    return(write.csv(format(rows, digits = 15), row.names = FALSE, quote = c(1, 2, 3)))
  }
  stamp <- if (any(trials$simulated == 1)) "SIMULATED: every participant is a program.\n" else ""
  cat(stamp, "\nOver participants, by Student's t: the result to quote\n", sep = "")
  if (is.null(people)) cat("  fewer than two participants: there is none\n") else print_rows(people)
  cat("\nOver trials, by a logit model in which participants differ:\n")
  cat(paste0(strwrap(model$said, 98, exdent = 2), "\n"), sep = "")
  print_rows(model$rows)
  if (!is.null(model$fit)) {
    cat("  Standard deviations between participants, and images if they are random, in log odds:\n")
    print(lme4::VarCorr(model$fit))
  }
  cat("\n", images_in_words(trials), stamp, sep = "")
}

if (sys.nframe() == 0L) main(methods)
