# The functions of rating_model.R: for each scale, Student's t over participants' differences
# between methods, and a linear mixed model rating ~ method * class with random effects of
# participants for methods and classes. As a script it prints the results (--csv: with all digits);
# if sourced, it only defines functions.

fewest_participants <- 6

read_ratings <- function(file, methods) {
  text <- c("participant", "class", "method", "exemplar", "scale")
  ratings <- read.csv(file, na.strings = "", encoding = "UTF-8",
                      colClasses = setNames(rep("character", length(text)), text))
  prepared(ratings, methods)
}

prepared <- function(ratings, methods) {
  ratings$participant <- factor(ratings$participant)
  ratings$class <- factor(ratings$class, levels = unique(ratings$class))
  ratings$method <- droplevels(factor(ratings$method, levels = methods))
  ratings
}

pairs_of <- function(methods) {
  if (length(methods) < 2) list() else combn(methods, 2, simplify = FALSE)
}

# People who do not differ have no t and no interval.
row_of <- function(by, first, second, estimate, error, df) {
  if (error < 1e-12) error <- NA
  t <- estimate / error
  reach <- qt(0.975, df) * error
  data.frame(by, first, second, estimate, low = estimate - reach, high = estimate + reach, t, df,
             p = 2 * pt(-abs(t), df))
}

with_holm <- function(rows) {
  if (!is.null(rows)) rows$p_holm <- p.adjust(rows$p, "holm")
  rows
}

# --- Participants ---

# The mean over classes by participant and method; NA unless the participant rated every class.
own_means <- function(ratings) {
  cells <- tapply(ratings$rating, list(ratings$participant, ratings$method, ratings$class), mean)
  apply(cells, c(1, 2), mean)
}

of_participants <- function(ratings) {
  means <- own_means(ratings)
  with_holm(do.call(rbind, lapply(pairs_of(levels(ratings$method)), function(pair) {
    difference <- means[, pair[1]] - means[, pair[2]]
    difference <- difference[!is.na(difference)]
    n <- length(difference)
    if (n < 2) return(NULL)
    row_of("t over participants", pair[1], pair[2], mean(difference), sd(difference) / sqrt(n),
           n - 1)
  })))
}

# --- Trials ---

# Sum-coded columns of a factor, so that a method's effect is the one over all classes.
coded <- function(ratings, name) {
  n <- nlevels(ratings[[name]])
  if (n < 2) return(list(ratings = ratings, columns = character()))
  columns <- paste0(name, seq_len(n - 1))
  ratings[columns] <- contr.sum(n)[as.integer(ratings[[name]]), , drop = FALSE]
  list(ratings = ratings, columns = columns)
}

# The random effects of participants, starting with the most complete. All include the methods: a
# model in which people differ only in level mistakes chance for a difference between methods too
# often.
random_terms <- function(methods, classes) {
  inner <- unique(list(c("1", methods, classes), c("1", methods)))
  unlist(lapply(inner, function(terms) {
    paste0("(", paste(terms, collapse = " + "), c(" | ", " || "), "participant)")
  }))
}

# The fit, or the reason why there is none, as text.
fitted_model <- function(formula, ratings) {
  fit <- tryCatch(suppressMessages(suppressWarnings(
    lme4::lmer(formula, data = ratings, control = lme4::lmerControl(optimizer = "bobyqa")))),
    error = function(failure) conditionMessage(failure))
  if (is.character(fit)) return(paste("it cannot be fitted:", fit))
  if (lme4::isSingular(fit)) {
    return("it is singular (a variance is estimated as 0, or a correlation as 1)")
  }
  if (length(fit@optinfo$conv$lme4$messages) > 0) return("it did not converge")
  fit
}

# Differences of all pairs over the classes. There are as many degrees of freedom as participants,
# minus one, because the effects differ between participants.
of_model <- function(fit, ratings, columns) {
  methods <- levels(ratings$method)
  codes <- contr.sum(length(methods))
  rownames(codes) <- methods
  covariance <- as.matrix(vcov(fit))[columns, columns, drop = FALSE]
  with_holm(do.call(rbind, lapply(pairs_of(methods), function(pair) {
    weights <- codes[pair[1], ] - codes[pair[2], ]
    row_of("mixed model", pair[1], pair[2], sum(weights * lme4::fixef(fit)[columns]),
           sqrt(drop(weights %*% covariance %*% weights)), nlevels(ratings$participant) - 1)
  })))
}

# The rows of the first model that the ratings determine, with the sentences to print.
of_ratings <- function(ratings) {
  none <- function(...) list(rows = NULL, said = c(...))
  if (nlevels(ratings$method) < 2) return(none("No model: there is one method."))
  if (!requireNamespace("lme4", quietly = TRUE)) {
    return(none(paste("No model: the package lme4 is missing; install.packages(\"lme4\"), or on",
                      "Debian apt-get install r-cran-lme4.")))
  }
  if (nlevels(ratings$participant) < fewest_participants) {
    return(none(sprintf("No model: fewer than %d participants do not tell how people differ.",
                        fewest_participants)))
  }
  methods <- coded(ratings, "method")
  classes <- coded(methods$ratings, "class")
  group <- function(columns) paste0("(", paste(columns, collapse = " + "), ")")
  fixed <- if (length(classes$columns) == 0) group(methods$columns) else {
    paste(group(methods$columns), "*", group(classes$columns))
  }
  said <- character()
  for (random in random_terms(methods$columns, classes$columns)) {
    shown <- paste("rating ~", fixed, "+", random)
    fit <- fitted_model(as.formula(shown), classes$ratings)
    if (!is.character(fit)) {
      return(list(rows = of_model(fit, ratings, methods$columns),
                  said = c(said, paste("Model:", shown)), fit = fit))
    }
    said <- c(said, paste0("Model: ", shown, ": not used, because ", fit, "."))
  }
  none(said, "No model of the trials: quote the t over participants.")
}

# --- What is printed ---

as_p <- function(p) if (p < 1e-4) "p < 0.0001" else sprintf("p = %.3g", p)

print_rows <- function(rows) {
  for (i in seq_len(NROW(rows))) {
    row <- rows[i, ]
    if (is.na(row$t)) {
      cat(sprintf("  %s less %s: %.3f; people do not differ, so that there is no t\n", row$first,
                  row$second, row$estimate))
      next
    }
    holm <- if (row$p_holm != row$p) paste0(", ", as_p(row$p_holm), " after Holm") else ""
    cat(sprintf("  %s less %s: %.3f, 95 %% %.3f to %.3f; t(%g) = %.2f, %s%s\n", row$first,
                row$second, row$estimate, row$low, row$high, row$df, row$t, as_p(row$p), holm))
  }
}

print_scale <- function(scale, people, model) {
  cat("\nScale ", scale, "\nOver participants, by Student's t: the result to quote\n", sep = "")
  if (is.null(people)) cat("  fewer than two participants or methods: there is none\n")
  print_rows(people)
  cat("Over trials, by a linear model in which participants differ:\n")
  cat(paste0(strwrap(model$said, 98, exdent = 2), "\n"), sep = "")
  print_rows(model$rows)
  if (!is.null(model$fit)) print(lme4::VarCorr(model$fit))
}

main <- function(methods) {
  arguments <- commandArgs(trailingOnly = FALSE)
  script <- sub("^--file=", "", grep("^--file=", arguments, value = TRUE))
  folder <- if (length(script) == 1) dirname(normalizePath(script)) else getwd()
  all <- read_ratings(file.path(folder, "rating_model.csv"), methods)
  if (nrow(all) == 0) {
    message("No trial counts yet: there is nothing to analyse.")
    quit(save = "no", status = 1)
  }
  digits <- "--csv" %in% arguments
  stamp <- if (any(all$simulated == 1)) "SIMULATED: every participant is a program.\n" else ""
  if (!digits) cat(stamp)
  rows <- NULL
  for (scale in unique(all$scale)) {
    ratings <- prepared(droplevels(all[all$scale == scale, ]), methods)
    people <- of_participants(ratings)
    model <- of_ratings(ratings)
    found <- rbind(people, model$rows)
    if (digits && !is.null(found)) rows <- rbind(rows, data.frame(scale, found))
    if (!digits) print_scale(scale, people, model)
  }
  if (!is.null(rows)) {
    write.csv(format(rows, digits = 15), row.names = FALSE, quote = c(1, 2, 3, 4))
  }
  if (!digits) cat("\n", stamp, sep = "")
}

if (sys.nframe() == 0L) main(methods)
