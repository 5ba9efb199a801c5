library(ggplot2)

arguments <- commandArgs(FALSE)
own <- sub("^--file=", "", grep("^--file=", arguments, value = TRUE))
stem <- sub("[.]r$", "", if (length(own)) own[1] else file.choose())
table <- read.csv(paste0(stem, ".csv"), colClasses = c(text = "character", name = "character"))
layer <- function(number) {
  rows <- table[table$layer == number, ]
  rows$text <- factor(rows$text, unique(rows$text))
  rows
}
rule <- function(rows, colour, ...) {
  level <- rows[!is.na(rows$y), ]
  upright <- rows[is.na(rows$y), ]
  list(
    geom_rect(aes(xmin = -Inf, xmax = Inf, ymin = low, ymax = high), level[!is.na(level$low), ],
              fill = colour, alpha = 0.16),
    geom_rect(aes(ymin = -Inf, ymax = Inf, xmin = low, xmax = high), upright[!is.na(upright$low), ],
              fill = colour, alpha = 0.16),
    geom_hline(aes(yintercept = y), level, colour = colour, ...),
    geom_vline(aes(xintercept = x), upright[!is.na(upright$x), ], colour = colour, ...),
    geom_text(aes(x = Inf, y = y, label = text), level, colour = colour, size = 2.8, hjust = 1,
              vjust = -0.3)
  )
}
picture <- function(rows, number) {
  raster <- png::readPNG(paste0(stem, "-", number, ".png"))
  lapply(seq_len(nrow(rows)), function(i) {
    annotation_raster(raster, rows$x[i], rows$low[i], rows$high[i], rows$y[i])
  })
}
panels <- list()
