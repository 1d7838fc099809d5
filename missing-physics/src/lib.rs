//! Tells what a model lacks: residuals, where they fail, which missing term explains them, at a stated false-alarm rate.
