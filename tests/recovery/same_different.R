# Rscript tests/recovery/same_different.R STUDIES: what the mean of participants' own d' of "same or different" would
# be, exactly, and what the bootstrap interval of the pooled d' covers. Prints rows of docs/procedures-recovery.md.
studies <- as.integer(commandArgs(trailingOnly = TRUE)[1])
if (is.na(studies) || studies < 10) stop("usage: Rscript same_different.R STUDIES (10 or more)")
false_alarms <- 0.25
draws <- 599

# d' of shares of "different", 0 with fewer hits than false alarms; shares of a d' and a criterion.
models <- list(
  differencing = list(
    d_prime = function(hits, false) {
      k <- -sqrt(2) * qnorm(false / 2)
      low <- 0 * hits
      high <- low + 50
      for (i in 1:50) {
        middle <- (low + high) / 2
        short <- pnorm((middle - k) / sqrt(2)) + pnorm((-middle - k) / sqrt(2)) < hits
        low <- ifelse(short, middle, low)
        high <- ifelse(short, high, middle)
      }
      (low + high) / 2
    },
    criterion = function(n, sd) -sqrt(2) * qnorm(false_alarms / 2) * exp(rnorm(n, sd = sd)),
    hits = function(d, k) pnorm((d - k) / sqrt(2)) + pnorm((-d - k) / sqrt(2)),
    false = function(d, k) 2 * pnorm(-k / sqrt(2))),
  independent = list(
    d_prime = function(hits, false) {
      above <- pmax(2 * pnorm((qnorm(hits) - qnorm(false)) / 2) - 1, 0)
      2 * qnorm((1 + sqrt(above)) / 2)
    },
    criterion = function(n, sd) rnorm(n, sd = sd),
    hits = function(d, k) pnorm(qnorm(pnorm(d / 2)^2 + pnorm(-d / 2)^2) - k),
    false = function(d, k) pnorm(-qnorm(pnorm(d / 2)^2 + pnorm(-d / 2)^2) - k)))

inner <- function(count, n) pmin(pmax(count, 0.5), n - 0.5) / n

# The exact mean of one participant's d', with n trials of each kind; with fewer hits than false alarms minus the
# d' of the exchanged shares, or guessers would have a mean above 0.
mean_of_own <- function(model, d, n) {
  k <- model$criterion(1, 0)
  counts <- expand.grid(hits = 0:n, false = 0:n)
  hits <- inner(counts$hits, n)
  false <- inner(counts$false, n)
  own <- sign(hits - false) * model$d_prime(pmax(hits, false), pmin(hits, false))
  sum(own * dbinom(counts$hits, n, model$hits(d, k)) * dbinom(counts$false, n, model$false(d, k)))
}

pooled <- function(model, hits, false, n) {
  hits <- inner(hits, n)
  false <- inner(false, 3 * n)
  ifelse(hits < false, 0, model$d_prime(hits, false))
}

# Of people with 20 trials of two that differ at the level and 60 of two alike at all three.
study <- function(model, people, d, criterion_sd) {
  k <- model$criterion(people, criterion_sd)
  own <- abs(rnorm(people, d, 0.3 * d))
  hits <- rbinom(people, 20, model$hits(own, k))
  false <- rbinom(people, 60, model$false(own, k))
  drawn <- matrix(sample.int(people, people * draws, TRUE), people)
  values <- pooled(model, colSums(matrix(hits[drawn], people)), colSums(matrix(false[drawn], people)), 20 * people)
  tail <- pnorm(qt(0.025, people - 1) * sqrt(people / (people - 1)))
  c(pooled(model, sum(hits), sum(false), 20 * people), quantile(values, c(tail, 1 - tail), type = 6))
}

# The d' of the shares of very many people.
true_pooled <- function(model, d, criterion_sd) {
  k <- model$criterion(2e5, criterion_sd)
  own <- abs(rnorm(2e5, d, 0.3 * d))
  hits <- mean(model$hits(own, k))
  false <- mean(model$false(own, k))
  if (hits <= false) 0 else model$d_prime(hits, false)
}

cat("\n## Same or different\n\nBy `Rscript tests/recovery/same_different.R ", studies, "`. The mean of participants' own d'",
    " (not reported),\nexactly, at a share of false alarms of .25 or without a bias:\n\n",
    "| observer | trials of each kind | d' 0.5 | d' 1 | d' 2 |\n| --- | --- | --- | --- | --- |\n", sep = "")
for (name in names(models)) for (n in c(10, 20, 50, 200)) {
  means <- sapply(c(0.5, 1, 2), function(d) mean_of_own(models[[name]], d, n))
  cat(sprintf("| %s | %d | %.2f | %.2f | %.2f |\n", name, n, means[1], means[2], means[3]))
}
cat("\nThe d' of all answers pooled, ", studies, " studies a row, of people with 20 trials of two that differ and 60 of",
    " two alike,\nwhose d' differ by an SD of .3 d':\n\n| observer | people | d' | SD of criteria | pooled, truly | found |",
    " covered |\n| --- | --- | --- | --- | --- | --- | --- |\n", sep = "")
set.seed(1)
for (name in names(models)) for (people in c(12, 24)) for (spread in c(0, 0.3)) for (d in c(0, 0.5, 1, 2)) {
  truth <- true_pooled(models[[name]], d, spread)
  found <- replicate(studies, study(models[[name]], people, d, spread))
  covered <- mean(found[2, ] - 1e-6 <= truth & truth <= found[3, ])
  cat(sprintf("| %s | %d | %.1f | %.1f | %.2f | %.2f | %.3f |\n", name, people, d, spread, truth, median(found[1, ]),
              covered))
}
