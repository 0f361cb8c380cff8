//! The engines against unlike methods on explicit graphs.

mod algebra;
mod anytime;
mod ascent;
mod both_ends;
mod brackets;
mod budgets;
mod classes;
mod edge_cases;
mod k_best;
mod laziness;
mod optimality;
mod ranking;
mod reference;
mod sample;
