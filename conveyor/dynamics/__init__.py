"""Starting and stopping: waves in the belt, from the steady result of the pipeline."""
