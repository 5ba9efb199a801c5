// The similarity choice model with partial pooling over participants. A participant who feels class i
// answers j with a probability in proportion to bias[j] * similarity[i, j]. Similarity is exp(-distance),
// symmetric, and 1 for a class and itself. Participants differ in how far apart all classes are for them,
// and in their biases; every method has parameters of its own. Without arrays, so that every version of
// Stan reads it.
data {
  int<lower=2> K;                      // classes
  int<lower=1> J;                      // participants, once for every method with an answer of theirs
  int<lower=1> M;                      // methods
  matrix<lower=0>[J * K, K] counts;    // rows: K presented classes of each participant; columns: answers
  matrix<lower=0, upper=1>[J, M] felt; // 1: the participant's row is of this method
}
transformed data {
  int pairs = choose(K, 2);
}
parameters {
  matrix[M, pairs] log_distance;       // (1, 2), (1, 3), .., (K - 1, K), of the median participant
  matrix[M, K] preference;             // log bias; only differences matter
  vector<lower=0>[M] distance_sd;      // between participants, of the log of all their distances
  vector<lower=0>[M] preference_sd;    // between participants, of their log biases
  vector[J] own_distance;
  matrix[J, K] own_preference;
}
model {
  matrix[J, pairs] apart =
      exp(felt * log_distance + rep_matrix((felt * distance_sd) .* own_distance, pairs));
  matrix[J, K] liking =
      felt * preference + rep_matrix(felt * preference_sd, K) .* own_preference;
  to_vector(log_distance) ~ normal(0.7, 1);
  to_vector(preference) ~ normal(0, 1);
  distance_sd ~ normal(0, 1);
  preference_sd ~ normal(0, 1);
  own_distance ~ normal(0, 1);
  to_vector(own_preference) ~ normal(0, 1);
  for (j in 1:J) {
    matrix[K, K] strength = rep_matrix(liking[j], K);
    int pair = 1;
    for (a in 1:(K - 1)) {
      for (b in (a + 1):K) {
        strength[a, b] -= apart[j, pair];
        strength[b, a] -= apart[j, pair];
        pair += 1;
      }
    }
    for (i in 1:K) {
      row_vector[K] answers = counts[(j - 1) * K + i];
      target += dot_product(answers, strength[i]) - sum(answers) * log_sum_exp(strength[i]);
    }
  }
}
generated quantities {
  matrix[M, pairs] similarity = exp(-exp(log_distance));
  matrix[M, K] bias;
  for (m in 1:M) bias[m] = softmax(preference[m]')';
}
