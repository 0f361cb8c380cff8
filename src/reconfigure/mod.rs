//! Actions, transient states, and the search space of a robot.
