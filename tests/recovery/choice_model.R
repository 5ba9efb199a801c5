# Rscript tests/recovery/choice_model.R [SEED]: the exported Stan program on one simulated study of 20
# participants whose similarities, biases and differences are known. Prints rows of docs/exports.md. Needs
# rstan (Debian: r-cran-rstan); compiling takes about a minute.
suppressMessages(library(rstan))
# Debian's r-cran-bh points to the system's Boost.
if (!file.exists(rstan_options("boost_lib"))) rstan_options(boost_lib = "/usr/include")
arguments <- commandArgs(trailingOnly = FALSE)
here <- dirname(normalizePath(sub("^--file=", "", grep("^--file=", arguments, value = TRUE))))
program <- file.path(here, "../../protocols/identification/analysis/choice_model_program.stan")
seed <- as.integer(c(commandArgs(trailingOnly = TRUE), "1")[1])
set.seed(seed)

K <- 5
J <- 20
repeats <- 10
similarity <- matrix(0.1, K, K)
similarity[1, 2] <- similarity[2, 1] <- 0.3
diag(similarity) <- 1
bias <- c(3, 2, 2, 2, 1) / 10
distance_sd <- 0.3
preference_sd <- 0.4

counts <- NULL
for (person in seq_len(J)) {
  strength <- similarity^exp(distance_sd * rnorm(1)) %*% diag(bias * exp(preference_sd * rnorm(K)))
  for (i in seq_len(K)) counts <- rbind(counts, t(rmultinom(1, repeats, strength[i, ])))
}
study <- list(K = K, J = J, M = 1, counts = counts, felt = matrix(1, J, 1))
fit <- stan(program, data = study, chains = 2, cores = 1, iter = 1500, warmup = 500, seed = seed,
                   refresh = 0)
shown <- c("similarity", "bias", "distance_sd", "preference_sd")
found <- summary(fit, shown, probs = c(0.025, 0.5, 0.975))$summary
truth <- c(similarity[lower.tri(similarity)], bias, distance_sd, preference_sd)
cat("| parameter | true | median | 95 % | R-hat |\n| --- | ---: | ---: | --- | ---: |\n")
for (i in seq_along(truth)) {
  cat(sprintf("| `%s` | %.3g | %.3f | %.3f to %.3f | %.3f |\n", rownames(found)[i], truth[i], found[i, "50%"],
              found[i, "2.5%"], found[i, "97.5%"], found[i, "Rhat"]))
}
inside <- truth >= found[, "2.5%"] & truth <= found[, "97.5%"]
divergent <- sum(sapply(get_sampler_params(fit, inc_warmup = FALSE), function(s) sum(s[, "divergent__"])))
cat(sprintf("\n%d of %d intervals hold the truth; %d divergent transitions; largest R-hat %.3f.\n", sum(inside),
            length(truth), divergent, max(found[, "Rhat"])))
